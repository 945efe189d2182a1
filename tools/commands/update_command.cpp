// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "engine/workspace/workspace.hpp"
#include "io/files/output_set.hpp"
#include "io/results/results.hpp"
#include "tools/commands/commands.hpp"
#include "tools/commands/compare_command.hpp"
#include "tools/commands/detect_command.hpp"
#include "tools/console/command_line.hpp"
#include "tools/run/input_files.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;

// The data that `read_result` reads.
constexpr std::array<const char*, 5> kComparedFiles = {"loops.ply", "boundary.ply", "sample.ply", "run.json",
                                                       "holes.json"};

struct UpdateArguments {
  explicit UpdateArguments(const Command& command) : run(command) {}

  fs::path workspace;
  std::vector<fs::path> added;
  std::vector<std::string> replaced;  // OLD=NEW
  ResultArguments run;
};

// The new file has the place of the old one, and its pose.
void replace_input(const std::string& given, std::vector<ScanInput>& inputs) {
  const std::size_t at = given.find('=');
  if (at == given.npos) throw WrongOption("--replace", "allowed: OLD=NEW, two names of files");
  const fs::path old = full_name(given.substr(0, at));
  const auto found = std::find_if(inputs.begin(), inputs.end(),
                                  [&](const ScanInput& input) { return full_name(input.file) == old; });
  if (found == inputs.end()) throw Error(old.string() + ": is no input of the run; lacuna status names them");
  found->file = given.substr(at + 1);
}

std::vector<ScanInput> changed_inputs(const UpdateArguments& arguments, const StoredRun& run,
                                      const FilesConfig& config) {
  std::vector<ScanInput> inputs = inputs_of(run.names);
  for (const std::string& given : arguments.replaced) replace_input(given, inputs);
  for (ScanInput& input : expand_inputs(arguments.added, read_options(config), config.input)) {
    const bool is_known = std::any_of(inputs.begin(), inputs.end(), [&](const ScanInput& other) {
      return full_name(other.file) == full_name(input.file);
    });
    if (is_known) throw Error(input.file.string() + ": is an input of the run already");
    inputs.push_back(std::move(input));
  }
  return inputs;
}

bool is_left_out(std::span<const double> box, std::span<const double> boxes) {
  for (std::size_t at = 0; at + 6 <= boxes.size(); at += 6) {
    if (std::ranges::equal(box, boxes.subspan(at, 6))) return true;
  }
  return false;
}

// Returns the parameters of the run before, then the parameters of the command line. Boxes add up.
FilesConfig changed_config(const RunArguments& arguments, const StoredRun& run, const fs::path& workspace) {
  FilesConfig base = config_of(run, workspace);
  const std::vector<double> before = std::exchange(base.input.leave_out, {});
  FilesConfig config = arguments.start(std::move(base));
  const std::vector<double> boxes = std::exchange(config.input.leave_out, before);
  for (std::size_t at = 0; at < boxes.size(); at += 6) {
    const auto box = std::span(boxes).subspan(at, 6);
    if (is_left_out(box, before))
      throw Error(workspace.string() + ": a box of --leave-out is left out already");
    config.input.leave_out.insert(config.input.leave_out.end(), box.begin(), box.end());
  }
  config.run.workspace = workspace.string();
  return config;
}

// Returns the folder that has the results of the run before; empty if none is known.
fs::path results_of(const fs::path& workspace) {
  for (const fs::path& folder : {earlier_parts(workspace), workspace}) {
    if (const auto note = read_note(folder, WorkspaceNote::kResults)) return *note;
  }
  return {};
}

// Results that the update may replace are kept with the parts, as far as they are compared.
void keep_results(const fs::path& results, const fs::path& kept) {
  if (results.empty() || !fs::exists(results / "holes.json") || fs::exists(kept / "holes.json")) return;
  fs::create_directories(kept);
  for (const char* name : kComparedFiles) {  // holes.json comes last
    if (!fs::exists(results / name)) continue;
    const fs::path partial = kept / (std::string(name) + ".partial");
    fs::copy_file(results / name, partial, fs::copy_options::overwrite_existing);
    fs::rename(partial, kept / name);
  }
}

// Writes the changes to a file, and returns them as text.
std::string write_changes(const Comparison& comparison, const ResultArguments& to) {
  nlohmann::ordered_json json{{"lacuna", LACUNA_VERSION}};
  json.update(comparison.json());
  OutputSet set(to.overwrite ? Overwrite::kAny : Overwrite::kOwn);
  set.add(to.out / kChangesFile, kJsonMark).write(json.dump(2) + "\n");
  set.commit();
  return "changes: " + comparison.print_counts() + "\n" + comparison.print_table();
}

void run_update(const UpdateArguments& arguments) {
  // An update that was stopped begins again with the run before it.
  const fs::path& folder = arguments.workspace;
  const fs::path source = is_workspace(earlier_parts(folder)) ? earlier_parts(folder) : folder;
  const StoredRun run = read_run(source);
  const auto made_from = made_from_of(source);
  const FilesConfig config = changed_config(arguments.run, run, folder);
  const std::vector<ScanInput> inputs = changed_inputs(arguments, run, config);
  ResultArguments to = arguments.run;
  if (to.out.empty()) to.out = results_of(folder);
  if (to.out.empty())
    throw Error(folder.string() + ": does not name the folder of its results; allowed: --out DIR");

  const fs::path kept = earlier_results(folder);
  const WorkspaceSteps steps{
      .begin =
          [&] {
            if (made_from_of(source) != made_from)
              throw Error(folder.string() + ": another update has changed it meanwhile");
            keep_results(results_of(folder), kept);
            begin_update(folder);
          },
      .end =
          [&] {
            std::string text;
            if (fs::exists(kept / "holes.json")) {
              text = write_changes(Comparison(read_result(kept), read_result(to.out)), to);
            } else {
              spdlog::warn("the results of the run before are gone: what has changed is not known");
            }
            return text;
          }};
  const std::string summary = detect_to(inputs, config, to, steps);
  if (!to.quiet) std::cout << summary;
}

}  // namespace

void add_update_command(const Command& program) {
  const Command command = program.add_command(
      "update", "Go on from a workspace with an input that has changed in places, and say what has changed");
  const auto arguments = std::make_shared<UpdateArguments>(command);
  command.add_option("WORKSPACE", arguments->workspace, "Folder of lacuna detect --workspace")
      .required()
      .type("DIR");
  command.add_option("--add", arguments->added, "Scan files, folders or @LISTs that come after the others")
      .type("SCAN");
  command
      .add_option("--replace", arguments->replaced,
                  "A file that takes the place of an input, such as a station that was aligned again")
      .type("OLD=NEW");
  command.option("--leave-out")
      .help("Points in these boxes do not take part, nor those in the boxes of the run before.");
  command.option("--out").help("Folder for the results. The default is the folder of the run before.");
  command.runs([arguments] { run_update(*arguments); });
}

}  // namespace lacuna::tools
