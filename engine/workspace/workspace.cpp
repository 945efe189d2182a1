// SPDX-License-Identifier: Apache-2.0
#include "engine/workspace/workspace.hpp"

#include "engine/model/tiling.hpp"
#include "engine/run/error.hpp"
#include "engine/store/sealed_part.hpp"

#include <algorithm>
#include <optional>
#include <regex>
#include <sstream>
#include <string_view>
#include <system_error>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

// The number changes with the records in the parts.
constexpr const char* kProgram = "lacuna " LACUNA_VERSION ", parts of form 6";
constexpr const char* kRun = "run";      // the part that says whose workspace it is
constexpr const char* kTasks = "tasks";  // the part that has the plan
constexpr std::string_view kLevel = "level-", kTiles = "tiles-";

using Lines = std::vector<std::string>;

// Returns "key = value" of the parameters that change this.
Lines parameter_lines(const Config& config, Changes changed) {
  Config copy = config;
  Lines lines;
  for (const Parameter& parameter : parameters(copy)) {
    if (parameter.changes == changed) lines.push_back(std::string(parameter.key) + " = " + parameter.print());
  }
  return lines;
}

std::string joined(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

Lines made_from(const Lines& identity, const Config& config) {
  Lines lines = {kProgram};
  for (const std::string& part : identity) lines.push_back("input: " + part);
  for (const std::string& line : parameter_lines(config, Changes::kPoints)) lines.push_back(line);
  return lines;
}

// Says whether the first level has a list of the points that each of its points represents.
std::string represented_line(const Config& config) {
  return first_edge(config.scale) > 0 && config.results.points ? "with the represented points\n" : "";
}

// Returns the first line of `lines` that the others do not have.
std::string first_other(const Lines& lines, const Lines& others) {
  for (const std::string& line : lines) {
    if (std::find(others.begin(), others.end(), line) == others.end()) return line;
  }
  return "nothing";
}

Lines split(std::string_view text, char end) {
  Lines lines(1);
  for (const char c : text) {
    if (c == end) {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  lines.pop_back();
  return lines;
}

// Returns the text of a stream. Returns nothing where it is damaged.
std::optional<std::string> text_of(const PartReader& part, std::string_view stream) {
  try {
    const std::vector<char> text = part.records<char>(stream, 0);
    return std::string(text.begin(), text.end());
  } catch (const DamagedFile&) {
    return std::nullopt;
  }
}

std::optional<PartReader> open_run(const fs::path& folder) {
  return PartReader::open(folder / kRun, digest_of(kRun));
}

// A process that is given no note keeps the one that is there.
bool is_other_note(const fs::path& folder, const std::string& note) {
  if (note.empty()) return false;
  const std::optional<PartReader> part = open_run(folder);
  return !part || text_of(*part, "note") != note;
}

bool is_workspace_name(const std::string& name) {
  static const std::regex parts(
      "(run|tasks|tiles|(survey|bucket|level-[0-9]{1,3})-[0-9]{1,5}|tiles-[0-9]{1,3}-[0-9a-f]{16})("
      "\\.[0-9a-f]{16}\\."
      "partial)?"
      "|level-[0-9]{1,3}-[0-9a-f]{16}\\.(points|normals)(\\.partial)?");
  return std::regex_match(name, parts);
}

// Refuses files of others that have names of parts: they would be replaced.
void refuse_others(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool is_begun = name.starts_with(std::string(kRun) + ".");
    if (is_workspace_name(name) && !is_begun)
      throw Error(entry.path().string() +
                  ": is not of a workspace, and has the name of a part of one; allowed: "
                  "an empty folder");
  }
}

}  // namespace

std::string evaluation_parameters(const Config& config) {
  return joined(parameter_lines(config, Changes::kEvaluation));
}

std::string output_parameters(const Config& config) {
  return joined(parameter_lines(config, Changes::kOutputs));
}

Digest digest_of(const std::string& made_from, const TaskShare& share) {
  return digest_of(made_from + "part " + std::to_string(share.task) + " of " + std::to_string(share.tasks));
}

std::string line_of(const Digest& checksum) {
  return std::to_string(checksum[0]) + " " + std::to_string(checksum[1]) + "\n";
}

void write_plan(const fs::path& folder, const TaskPlan& plan) {
  std::ostringstream text;
  text << plan.tasks << " " << plan.levels << " " << plan.tile_points << " " << plan.reads;
  PartWriter part(folder / kTasks);
  part.add("text", 0, std::span<const char>(text.str()));
  part.seal(digest_of(kTasks));
}

std::optional<TaskPlan> read_plan(const fs::path& folder) {
  const std::optional<PartReader> part = PartReader::open(folder / kTasks, digest_of(kTasks));
  std::istringstream text(part ? text_of(*part, "text").value_or("") : "");
  TaskPlan plan;
  if (!(text >> plan.tasks >> plan.levels >> plan.tile_points >> plan.reads)) return std::nullopt;
  return plan;
}

Config with_planned_tiles(Config config) {
  const fs::path folder = config.run.workspace;
  if (!folder.empty() && config.run.tile_points == 0)
    config.run.tile_points = static_cast<std::int64_t>(read_plan(folder).value_or(TaskPlan()).tile_points);
  return config;
}

std::optional<std::vector<std::string>> made_from_of(const fs::path& folder) {
  const std::optional<PartReader> part = open_run(folder);
  const std::optional<std::string> text = part ? text_of(*part, "made from") : std::nullopt;
  return text ? std::optional(split(*text, '\n')) : std::nullopt;
}

KeptRun read_run(const fs::path& folder) {
  const std::optional<PartReader> part = open_run(folder);
  const std::optional<std::string> inputs = part ? text_of(*part, "inputs") : std::nullopt;
  const std::optional<std::string> note = part ? text_of(*part, "note") : std::nullopt;
  if (!inputs || !note)
    throw Error(folder.string() + ": not the workspace of a run; allowed: the folder of --workspace");
  return {.names = split(*inputs, '\0'), .note = *note};
}

fs::path level_prefix(const fs::path& folder, std::size_t level) {
  return folder / (std::string(kLevel) + std::to_string(level) + "-");
}

fs::path tiles_prefix(const fs::path& folder, std::size_t level) {
  return folder / (std::string(kTiles) + std::to_string(level) + "-");
}

std::optional<std::size_t> level_of_part(const fs::path& file) {
  const std::string name = file.filename().string();
  if (!name.starts_with(kLevel) || file.has_extension()) return std::nullopt;
  return std::stoul(name.substr(kLevel.size()));
}

std::optional<std::size_t> level_of_column(const fs::path& file) {
  const std::string name = file.filename().string();
  if (!name.starts_with(kLevel) || !file.has_extension()) return std::nullopt;
  return std::stoul(name.substr(kLevel.size()));
}

std::optional<std::size_t> level_of_outputs(const fs::path& file) {
  const std::string name = file.filename().string();
  if (!name.starts_with(kTiles) || file.has_extension()) return std::nullopt;
  return std::stoul(name.substr(kTiles.size()));
}

bool is_workspace(const fs::path& folder) {
  return PartReader::is_part(folder / kRun);
}

std::vector<fs::path> workspace_files(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!is_workspace(folder)) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (fs::is_regular_file(entry.symlink_status()) && is_workspace_name(entry.path().filename().string()))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void fail_replaced(const Workspace& workspace) {
  throw Error(workspace.folder.string() +
              ": another process has replaced parts of it; the same command goes on from there");
}

void remove_part(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) throw Error(file.string() + ": cannot be removed: " + error.message());
}

Workspace open_workspace(const PointSource& scan, const Config& given, bool is_unit) {
  const fs::path folder = given.run.workspace;
  if (folder.empty()) return {};
  const Lines identity = scan.identity();
  if (identity.empty())
    throw Error(folder.string() + ": no workspace can be kept for points that are not read from files");
  const Lines now = made_from(identity, given);
  const std::optional<Lines> before = made_from_of(folder);
  if (before && *before != now) {
    throw Error(
        folder.string() + ": the workspace of another run: \"" + first_other(*before, now) + "\" there, \"" +
        first_other(now, *before) +
        "\" here; allowed: the same input and parameters, or another folder; lacuna clean removes this one");
  }
  if (!is_workspace(folder)) refuse_others(folder);
  for (const fs::path& file : workspace_files(folder)) {
    if (!is_unit && file.extension() == kUnsealed) remove_part(file);
  }
  if (!before || is_other_note(folder, given.run.note)) {
    std::string inputs;
    for (const std::string& name : scan.names()) inputs += name + '\0';
    PartWriter part(folder / kRun);
    for (const auto& [stream, text] : {std::pair<std::string_view, std::string>{"made from", joined(now)},
                                       {"inputs", inputs},
                                       {"note", given.run.note}})
      part.add(stream, 0, std::span<const char>(text));
    part.seal(digest_of(kRun));
  }
  return {.folder = folder,
          .made_from = joined(now) + represented_line(given),
          .plan = read_plan(folder).value_or(TaskPlan()),
          .is_unit = is_unit};
}

}  // namespace lacuna
