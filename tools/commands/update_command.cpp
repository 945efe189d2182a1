// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "engine/workspace/workspace.hpp"
#include "io/files/output_set.hpp"
#include "io/results/results.hpp"
#include "tools/commands/commands.hpp"
#include "tools/commands/compare_command.hpp"
#include "tools/commands/detect_command.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/visible_text.hpp"
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

// A run with the changes of an update. Each change that was made before is left as it is.
struct ChangedRun {
  std::vector<ScanInput> inputs;
  FilesConfig config;
  bool was_made = false;  // changes are given, and all were made before

  ScanInput* find(const fs::path& file) {
    const auto found = std::ranges::find(inputs, full_name(file),
                                         [](const ScanInput& input) { return full_name(input.file); });
    return found == inputs.end() ? nullptr : &*found;
  }
};

// The new file has the place of the old one, and its pose. Returns whether it was there before.
bool replace_input(const std::string& given, ChangedRun& run) {
  const std::size_t at = given.find('=');
  if (at == given.npos) throw WrongOption("--replace", "allowed: OLD=NEW, two names of files");
  const fs::path old = given.substr(0, at), replacing = given.substr(at + 1);
  ScanInput* const found = run.find(old);
  if (found == nullptr && run.find(replacing) == nullptr)
    throw Error(full_name(old).string() + ": is no input of the run; lacuna status names them");
  if (found != nullptr) found->file = replacing;
  return found == nullptr;
}

bool is_left_out(std::span<const double> box, std::span<const double> boxes) {
  for (std::size_t at = 0; at + 6 <= boxes.size(); at += 6) {
    if (std::ranges::equal(box, boxes.subspan(at, 6))) return true;
  }
  return false;
}

// Returns the parameters of the run before, then the parameters of the command line. Boxes and inputs add up.
ChangedRun changed_run(const UpdateArguments& arguments, const StoredRun& before) {
  const fs::path& workspace = arguments.workspace;
  FilesConfig base = config_of(before, workspace);
  std::vector<double> left_out = std::exchange(base.input.leave_out, {});
  ChangedRun run{.inputs = inputs_of(before.names), .config = arguments.run.start(std::move(base))};
  std::size_t given = 0, made = 0;
  const auto count = [&](bool was_made) {
    ++given;
    made += was_made;
    return was_made;
  };
  const std::vector<double> boxes = std::exchange(run.config.input.leave_out, std::move(left_out));
  for (std::size_t at = 0; at < boxes.size(); at += 6) {
    const auto box = std::span(boxes).subspan(at, 6);
    std::vector<double>& all = run.config.input.leave_out;
    if (!count(is_left_out(box, all))) all.insert(all.end(), box.begin(), box.end());
  }
  for (const std::string& replaced : arguments.replaced) count(replace_input(replaced, run));
  for (ScanInput& input : expand_inputs(arguments.added, read_options(run.config), run.config.input))
    if (!count(run.find(input.file) != nullptr)) run.inputs.push_back(std::move(input));
  run.config.run.workspace = workspace.string();
  run.was_made = given > 0 && made == given;
  return run;
}

// Returns the folder that has the results of the run before; empty if none is known.
fs::path results_of(const fs::path& workspace) {
  for (const fs::path& folder : {earlier_run(workspace), workspace}) {
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
  const fs::path source = is_workspace(earlier_run(folder)) ? earlier_run(folder) : folder;
  const StoredRun run = read_run(source);
  const auto made_from = made_from_of(source);
  const ChangedRun changed = changed_run(arguments, run);
  ResultArguments to = arguments.run;
  if (to.out.empty()) to.out = results_of(folder);
  if (to.out.empty())
    throw Error(folder.string() + ": does not name the folder of its results; allowed: --out DIR");
  if (changed.was_made && fs::exists(to.out / "holes.json")) {  // a scheduler repeats a command
    if (!to.quiet)
      std::cout << "nothing is left to do: " << visible(folder.string()) << " has these changes\n";
    return;
  }

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
  const std::string summary = detect_to(changed.inputs, changed.config, to, steps);
  if (!to.quiet) std::cout << summary;
}

}  // namespace

void add_update_command(const Command& program) {
  const Command command = program.add_command(
      "update", "Run again on an input that has changed in places, and say which holes have changed");
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
