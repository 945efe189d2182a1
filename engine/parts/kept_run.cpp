// SPDX-License-Identifier: Apache-2.0
#include "engine/parts/kept_run.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <regex>
#include <string_view>
#include <system_error>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

// The number changes with the records in the parts.
constexpr const char* kProgram = "lacuna " LACUNA_VERSION ", parts of form 11";
constexpr const char* kPlanPart = "plan.lacuna";

// The numbers of a plan, as the part has them.
struct PlanNumbers {
  std::uint64_t tasks, levels, tile_points, reads;
};

// Returns "key = value" of the parameters that change this, a line each.
std::string parameter_lines(const Config& config, Changes changed) {
  Config copy = config;
  std::string lines;
  for (const Parameter& parameter : parameters(copy)) {
    if (parameter.changes == changed) lines += std::string(parameter.key) + " = " + parameter.print() + "\n";
  }
  return lines;
}

std::string made_from(const std::vector<std::string>& identity, const Config& config) {
  std::string lines = std::string(kProgram) + "\n";
  for (const std::string& part : identity) lines += "input: " + part + "\n";
  lines += parameter_lines(config, Changes::kPoints);
  // Then the first level has a list of the points that each of its points represents.
  if (first_edge(config.scale) > 0 && config.results.points) lines += "with the represented points\n";
  return lines;
}

std::optional<PartReader> open_run(const fs::path& folder) {
  return PartReader::open(folder / kRunPart, std::nullopt);
}

void write_run(const fs::path& folder, const Parts& parts, const std::string& note) {
  std::string inputs;
  for (const std::string& name : parts.source.names) inputs += name + '\0';
  PartWriter part(folder / kRunPart);
  part.add("inputs", 0, std::span<const char>(inputs));
  part.add("note", 0, std::span<const char>(note));
  part.seal(parts.made_from);
}

// Returns the parts of a text, each of which ends with `end`.
std::vector<std::string> split(std::string_view text, char end) {
  std::vector<std::string> parts;
  for (std::size_t at; (at = text.find(end)) != std::string_view::npos; text.remove_prefix(at + 1))
    parts.emplace_back(text.substr(0, at));
  return parts;
}

// Returns the first line of `text` that is not in `other`, in quotes.
std::string first_other_line(const std::string& text, const std::string& other) {
  const std::vector<std::string> others = split(other, '\n');
  for (const std::string& line : split(text, '\n'))
    if (std::ranges::count(others, line) == 0) return "\"" + line + "\"";
  return "nothing";
}

// Refuses files of others that have names of parts: they would be replaced.
void refuse_others(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const bool is_begun = entry.path().filename().string().starts_with(std::string(kRunPart) + ".");
    if (is_kept_name(entry.path()) && !is_begun)
      throw Error(entry.path().string() +
                  ": is not of a workspace, and has the name of a part of one; allowed: "
                  "an empty folder");
  }
}

}  // namespace


bool is_kept_name(const fs::path& file) {
  static const std::regex names(
      "(run|plan|(survey|tiles|bucket|level|evaluate|loops)(-[0-9]+)?-[0-9a-f]+(\\.points|\\.normals)?)"
      "\\.lacuna(\\.[0-9a-f]{16})?(\\.partial)?");
  return std::regex_match(file.filename().string(), names);
}

bool is_kept_folder(const fs::path& folder) {
  return !kept_files(folder).empty();
}

fs::path part_file(const fs::path& folder, const std::string& step, const std::string& task) {
  return folder / (step + "-" + task + ".lacuna");
}

std::vector<fs::path> kept_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;  // a folder that is missing keeps nothing
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (fs::is_regular_file(entry.symlink_status()) && is_kept_name(entry.path()))
      files.push_back(entry.path());
  }
  if (!PartReader::is_part(folder / kRunPart) && std::ranges::none_of(files, PartReader::is_part))
    files.clear();
  std::sort(files.begin(), files.end());
  return files;
}

bool is_of_step(const fs::path& file, const std::string& step) {
  return file.filename().string().starts_with(step + "-");
}

void remove_kept(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) throw Error(file.string() + ": cannot be removed: " + error.message());
}

bool can_share_reading(const SourceParts& source, const Config& config) {
  return !source.points.empty() && first_edge(config.scale) == 0;
}

std::string evaluation_parameters(const Config& config) {
  return parameter_lines(config, Changes::kEvaluation);
}

std::string output_parameters(const Config& config) {
  return parameter_lines(config, Changes::kOutputs);
}

void write_plan(const fs::path& folder, const TaskPlan& plan) {
  PartWriter part(folder / kPlanPart);
  part.add_one("plan", PlanNumbers{plan.tasks, plan.levels, plan.tile_points, plan.reads});
  part.seal("");
}

std::optional<TaskPlan> read_plan(const fs::path& folder) {
  const std::optional<PartReader> part = PartReader::open(folder / kPlanPart, "");
  if (!part) return std::nullopt;
  try {
    const auto plan = part->record<PlanNumbers>("plan");
    return TaskPlan{.tasks = plan.tasks,
                    .levels = plan.levels,
                    .tile_points = plan.tile_points,
                    .reads = plan.reads != 0};
  } catch (const DamagedFile&) {
    return std::nullopt;
  }
}

TaskPlan require_plan(const fs::path& folder) {
  if (const std::optional<TaskPlan> plan = read_plan(folder)) return *plan;
  throw Error(folder.string() + ": has no plan; allowed: a workspace of lacuna plan");
}

Config with_planned_tiles(Config config) {
  const fs::path folder = config.run.workspace;
  if (!folder.empty() && config.run.tile_points == 0)
    config.run.tile_points = static_cast<std::int64_t>(read_plan(folder).value_or(TaskPlan()).tile_points);
  return config;
}

std::optional<std::vector<std::string>> made_from_of(const fs::path& folder) {
  const std::optional<PartReader> part = open_run(folder);
  const std::optional<std::string> text = part ? part->made_from() : std::nullopt;
  return text ? std::optional(split(*text, '\n')) : std::nullopt;
}

KeptRun read_run(const fs::path& folder) {
  const std::optional<PartReader> part = open_run(folder);
  const std::optional<std::string> inputs = part ? part->text("inputs") : std::nullopt;
  const std::optional<std::string> note = part ? part->text("note") : std::nullopt;
  if (!inputs || inputs->empty() || !note)  // other parts have no inputs
    throw Error(folder.string() + ": not the workspace of a run; allowed: the folder of --workspace");
  return {.names = split(*inputs, '\0'), .note = *note};
}

Parts open_parts(const PointSource& scan, const Config& config, Progress& progress, Opener opener) {
  const fs::path folder = config.run.workspace;
  if (folder.empty()) return {};
  SourceParts source = scan.parts();
  if (source.identity.empty())
    throw Error(folder.string() + ": no workspace can be kept for points that are not read from files");
  Parts parts{.folder = folder,
              .made_from = made_from(source.identity, config),
              .source = std::move(source),
              .plan = opener == Opener::kUnit ? require_plan(folder) : read_plan(folder).value_or(TaskPlan()),
              .is_unit = opener != Opener::kRun,
              .progress = &progress};
  if (!is_kept_folder(folder)) refuse_others(folder);
  const std::optional<PartReader> before = open_run(folder);
  const std::optional<std::string> was = before ? before->made_from() : std::nullopt;
  const bool is_same = was == parts.made_from;
  if (opener == Opener::kUnit && was && !is_same) {
    throw Error(folder.string() +
                ": was planned for another run: " + first_other_line(*was, parts.made_from) + " there, " +
                first_other_line(parts.made_from, *was) +
                " here; allowed: the input and parameters of the plan, or lacuna plan again");
  }
  if (parts.plan.reads && !can_share_reading(parts.source, config)) {  // it was planned for another run
    parts.plan.reads = false;
    write_plan(folder, parts.plan);
  }
  if (opener == Opener::kRun) {
    for (const fs::path& file : kept_files(folder))
      if (file.extension() == kUnsealed) remove_kept(file);
  }
  // A process that is given no note keeps the one that is there.
  const std::string& note = config.run.note;
  if (!is_same || (!note.empty() && before->text("note") != note)) write_run(folder, parts, note);
  return parts;
}

}  // namespace lacuna
