// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "engine/run/memory.hpp"
#include "io/read/files/number.hpp"
#include "io/read/files/output_file.hpp"
#include "io/write/report/render.hpp"
#include "io/write/report/report.hpp"
#include "io/write/report/scene.hpp"
#include "io/write/results/results.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/terminal.hpp"
#include "tools/run/run_program.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

namespace lacuna::tools {

using namespace io;
namespace fs = std::filesystem;

namespace {

struct ReportArguments {
  std::filesystem::path folder;
  bool overwrite = false;
};

void run_report(const ReportArguments& arguments) {
  if (fs::exists(arguments.folder / kVoidsFile) && !fs::exists(arguments.folder / "holes.json"))
    throw Error(arguments.folder.string() +
                ": has the results of lacuna check, whose --report writes their sheet");
  const Overwrite overwrite = arguments.overwrite ? Overwrite::kAny : Overwrite::kOwn;
  const std::filesystem::path file = write_report(arguments.folder, overwrite);
  std::cout << "written: " << visible(file.string()) << "\n";
}

}  // namespace

void add_report_command(CLI::App& program) {
  CLI::App& command = *program.add_subcommand(
      "report", "Write report.html, the scan and its holes in 3D, for the results in a folder");
  const auto arguments = std::make_shared<ReportArguments>();
  add_results_folder(command, arguments->folder);
  command.add_flag("--overwrite", arguments->overwrite,
                   "Replace a report.html that Lacuna did not write, too");
  command.callback([arguments] { run_report(*arguments); });
}

namespace {

constexpr std::size_t kLeastSide = 16, kMostSide = 16384;  // pixels

struct RenderArguments {
  explicit RenderArguments(CLI::App& command)
      : process(command, {.common = {"memory_limit"}, .rare = {}, .has_config_file = false}) {}

  ParameterOptions process;
  std::filesystem::path folder, out;
  std::string view = "oblique", size = "1600x1000";
  std::optional<double> most_height;
  bool as_it_came = false, without_ids = false;
  bool overwrite = false;
};

std::pair<std::size_t, std::size_t> parse_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  std::size_t width = 0, height = 0;
  const auto is_allowed = [](std::size_t side) { return side >= kLeastSide && side <= kMostSide; };
  if (cross == text.npos || !parse_number(text.substr(0, cross), width) ||
      !parse_number(text.substr(cross + 1), height) || !is_allowed(width) || !is_allowed(height)) {
    throw WrongOption("--size", text + " is not allowed; WIDTHxHEIGHT of 16 to 16384 pixels is");
  }
  return {width, height};
}

// The height of the ceiling that a view leaves out. A loop that reaches above it keeps it, as in the page.
std::optional<double> ceiling_before(std::optional<std::size_t> loop, const Scene& scene) {
  const std::vector<double> cuts = ceiling_cuts(scene);
  const auto is_above = [&](const Eigen::Vector3f& p) { return scene.origin.z() + p.z() > cuts.front(); };
  if (cuts.empty() || (loop && std::ranges::any_of(scene.loops.vertices_of(*loop), is_above)))
    return std::nullopt;
  return cuts.front();
}

void run_render(const RenderArguments& arguments) {
  const auto [width, height] = parse_size(arguments.size);
  const std::uint64_t memory = Memory::share(arguments.process.start().run.memory_limit).work;
  const Overwrite overwrite = arguments.overwrite ? Overwrite::kAny : Overwrite::kOwn;
  const MadeFolder parent(std::filesystem::absolute(arguments.out).parent_path());
  check_output(arguments.out, picture_mark(), overwrite);
  if (arguments.most_height && !std::isfinite(*arguments.most_height))
    throw WrongOption("--hide-above", "a finite height is allowed");
  Scene scene = read_scene(arguments.folder, limits_within(memory));
  const std::optional<std::size_t> chosen = loop_of_view(scene, arguments.view);
  const std::optional<double> most_height =
      arguments.most_height ? arguments.most_height : ceiling_before(chosen, scene);
  const auto folded = std::ranges::count(small_loops(scene.loops), true);
  if (most_height) scene.highest = static_cast<float>(*most_height - scene.origin.z());
  const View view = find_view(scene, arguments.view, width, height);
  const PictureSize size{width, height};
  NewFile out(arguments.out, picture_mark(), overwrite);
  PngWriter png(size, out.content());
  const PictureStyle style{.as_it_came = arguments.as_it_came, .has_ids = !arguments.without_ids};
  render(
      scene, view, size, style, [&](std::span<const Colour> row) { png.write(row); },
      std::min<std::uint64_t>(kBandBytes, memory / 2));
  png.finish();
  out.commit();
  std::cout << "written: " << visible(arguments.out.string()) << "\n";
  if (most_height && !arguments.most_height)
    std::cout << "left out: the ceiling above " << most_height.value()
              << "; --hide-above with a greater height keeps it\n";
  if (folded > 0)
    std::cout << "left out: " << folded << " loops below " << LoopEvidence::kSmallWidth
              << " spacings; --view ID draws one\n";
  if (scene.strays > 0)
    std::cout << "left out: " << scene.strays << (scene.strays == 1 ? " point" : " points")
              << " far from all others\n";
}

}  // namespace

void add_render_command(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("render", "Draw the scan and its holes as a PNG, without a browser");
  const auto arguments = std::make_shared<RenderArguments>(command);
  add_results_folder(command, arguments->folder);
  command.add_option("--out", arguments->out, "Picture to write, in PNG; its name ends in .png")
      ->type_name("FILE")
      ->check(name_ending_in(".png"))
      ->required();
  command
      .add_option("--view", arguments->view,
                  "oblique, top (from above), front (along y), side (along -x), or the id of a loop")
      ->type_name("VIEW")
      ->capture_default_str();
  command.add_option("--size", arguments->size, "Width and height in pixels")
      ->type_name("WxH")
      ->capture_default_str();
  command
      .add_option("--hide-above", arguments->most_height,
                  "Draw nothing above this height, in units of the scan; by default nothing above the "
                  "highest ceiling of a scan within walls")
      ->check(real_number())
      ->type_name("Z");
  command.add_flag("--as-it-came", arguments->as_it_came,
                   "Colours or intensities of the scan, where it has them, not probabilities");
  command.add_flag("--no-ids", arguments->without_ids, "Without the ids of the loops");
  command.add_flag("--overwrite", arguments->overwrite,
                   "Replace a file that lacuna render did not write, too");
  command.callback([arguments] { run_render(*arguments); });
}

}  // namespace lacuna::tools
