#include "tools/update_command.hpp"

#include "engine/run/error.hpp"
#include "engine/workspace/workspace.hpp"
#include "io/results/output_set.hpp"
#include "io/results/results.hpp"
#include "tools/compare_command.hpp"
#include "tools/detect_command.hpp"
#include "tools/input_files.hpp"
#include "tools/visible_text.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;

struct UpdateArguments {
  explicit UpdateArguments(CLI::App& command) : run(command) {}

  fs::path workspace;
  std::vector<fs::path> added;
  std::vector<std::string> replaced;  // OLD=NEW
  ResultArguments run;
};

// The new file has the place of the old one, and its pose.
void replace_input(const std::string& given, std::vector<ScanInput>& inputs) {
  const std::size_t at = given.find('=');
  if (at == given.npos) throw CLI::ValidationError("--replace", "allowed: OLD=NEW, two names of files");
  const fs::path old = full_name(given.substr(0, at));
  const auto found = std::find_if(inputs.begin(), inputs.end(),
                                  [&](const ScanInput& input) { return full_name(input.file) == old; });
  if (found == inputs.end()) throw Error(old.string() + ": is no input of the run; lacuna status names them");
  found->file = given.substr(at + 1);
}

std::vector<ScanInput> changed_inputs(const UpdateArguments& arguments, const StoredRun& run,
                                      const Config& config) {
  std::vector<ScanInput> inputs = inputs_of(run.names);
  for (const std::string& given : arguments.replaced) replace_input(given, inputs);
  for (ScanInput& input : expand_inputs(arguments.added, {.columns = config.input.columns})) {
    const bool is_known = std::any_of(inputs.begin(), inputs.end(), [&](const ScanInput& other) {
      return full_name(other.file) == full_name(input.file);
    });
    if (is_known) throw Error(input.file.string() + ": is an input of the run already");
    inputs.push_back(std::move(input));
  }
  return inputs;
}

void write_changes(const Comparison& comparison, const fs::path& out, Overwrite overwrite) {
  nlohmann::ordered_json json{{"lacuna", LACUNA_VERSION}};
  json.update(comparison.json());
  OutputSet set(overwrite);
  set.add(out / kChangesFile, kJsonMark).write(json.dump(2) + "\n");
  set.commit();
}

void run_update(const UpdateArguments& arguments) {
  // An update that was stopped begins again with the run before it.
  const fs::path& folder = arguments.workspace;
  const fs::path earlier = earlier_parts(folder);
  const fs::path& source = workspace_files(earlier).empty() ? folder : earlier;
  const StoredRun run = read_run(source);
  Config base = run.config;
  base.input.leave_out.clear();
  Config config = arguments.run.start(std::move(base));
  const std::vector<double> boxes = std::exchange(config.input.leave_out, run.config.input.leave_out);
  config.input.leave_out.insert(config.input.leave_out.end(), boxes.begin(), boxes.end());
  config.run.workspace = folder.string();
  const std::vector<ScanInput> inputs = changed_inputs(arguments, run, config);

  const fs::path results = read_note(source, WorkspaceNote::kResults).value_or("");
  ResultArguments to = arguments.run;
  if (to.out.empty()) to.out = results;
  if (to.out.empty()) throw CLI::RequiredError("--out");
  std::optional<ComparedResult> before;
  if (fs::exists(results / "holes.json")) before = read_result(results);

  std::string summary = detect_to(inputs, config, to, WorkspaceUse::kUpdate);
  if (before) {
    const Comparison comparison(*std::move(before), read_result(to.out));
    write_changes(comparison, to.out, to.overwrite ? Overwrite::kAny : Overwrite::kOwn);
    summary += "changes: " + comparison.print_counts() + "\n" + comparison.print_table();
  } else {
    spdlog::warn("the results of the run before are not there any more: what has changed is not said");
  }
  if (!to.quiet) std::cout << summary;
}

}  // namespace

void add_update_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "update", "Go on from a workspace with an input that has changed in places, and say what has changed");
  const auto arguments = std::make_shared<UpdateArguments>(*command);
  command->add_option("WORKSPACE", arguments->workspace, "Folder of lacuna detect --workspace")
      ->required()
      ->type_name("DIR");
  command->add_option("--add", arguments->added, "Scan files, folders or @LISTs that come after the others")
      ->type_name("SCAN");
  command
      ->add_option("--replace", arguments->replaced,
                   "A file that takes the place of an input, such as a station that was aligned again")
      ->type_name("OLD=NEW");
  command->get_option("--leave-out")
      ->description("Points in these boxes do not take part, nor those in the boxes of the run before.");
  command->get_option("--out")->description("Folder for the results; those of the run before by default");
  command->callback([arguments] { run_update(*arguments); });
}

}  // namespace lacuna::tools
