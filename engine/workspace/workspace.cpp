#include "engine/workspace/workspace.hpp"

#include "engine/model/tiling.hpp"
#include "engine/run/error.hpp"
#include "engine/store/sealed_part.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRun = "run";    // the part that says whose workspace it is
constexpr const char* kPlan = "plan";  // of a run that several processes share
constexpr std::string_view kLevel = "level-", kTiles = "tiles-";

using Lines = std::vector<std::string>;

// "key = value" of the parameters that are wanted.
template <class Wanted>
Lines parameter_lines(const Config& config, Wanted&& is_wanted) {
  Config copy = config;
  Lines lines;
  for (const Parameter& parameter : parameters(copy)) {
    if (is_wanted(parameter)) lines.push_back(std::string(parameter.key) + " = " + parameter.print());
  }
  return lines;
}

std::string joined(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

bool is_of_input(const Parameter& p) {
  const std::set<std::string_view> sections = {"input", "scale", "neighbourhood", "criteria"};
  return sections.contains(p.section) || p.key == "crease_threshold";
}

bool is_of_evaluation(const Parameter& p) {
  const std::set<std::string_view> sections = {"coherence", "loops", "spanning", "tangential"};
  return sections.contains(p.section);
}

bool is_of_outputs(const Parameter& p) {
  const std::set<std::string_view> keys = {"points", "vdb", "sample_points", "orient_normals"};
  return keys.contains(p.key);
}

Lines made_from(const Lines& identity, const Config& config) {
  Lines lines = {"lacuna " LACUNA_VERSION};
  for (const std::string& part : identity) lines.push_back("input: " + part);
  for (const std::string& line : parameter_lines(config, is_of_input)) lines.push_back(line);
  return lines;
}

// The first line of `lines` that the others have not.
std::string first_other(const Lines& lines, const Lines& others) {
  for (const std::string& line : lines) {
    if (std::find(others.begin(), others.end(), line) == others.end()) return line;
  }
  return "nothing";
}

Lines split(std::span<const char> text, char end) {
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

std::optional<PartReader> open_run(const fs::path& folder) {
  return PartReader::open(folder / kRun, digest_of(kRun));
}

std::optional<Lines> lines_of(const fs::path& folder) {
  const std::optional<PartReader> part = open_run(folder);
  if (!part) return std::nullopt;
  return split(part->records<char>("made from", 0), '\n');
}

bool is_workspace_name(const std::string& name) {
  const std::string stem = name.substr(0, name.find('.'));
  const auto is_number = [](const std::string& text) {
    return text.find_first_not_of("0123456789abcdef-") == std::string::npos;
  };
  return stem == kRun || stem == kPlan ||
         (stem.starts_with(kLevel) && is_number(stem.substr(kLevel.size()))) ||
         (stem.starts_with(kTiles) && is_number(stem.substr(kTiles.size())));
}

// Files of others that have names of parts would be replaced.
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
  return joined(parameter_lines(config, is_of_evaluation));
}

std::string output_parameters(const Config& config) {
  return joined(parameter_lines(config, is_of_outputs));
}

StoredRun read_run(const fs::path& folder) {
  const std::optional<PartReader> part = open_run(folder);
  if (!part)
    throw Error(folder.string() + ": not the workspace of a run; allowed: the folder of --workspace");
  StoredRun run{.inputs = split(part->records<char>("inputs", 0), '\0'), .config = {}};
  const std::vector<char> text = part->records<char>("config", 0);
  read_config_text({text.data(), text.size()}, folder / kRun, run.config);
  return run;
}

fs::path level_path(const fs::path& folder, std::size_t level) {
  return folder / (std::string(kLevel) + std::to_string(level));
}

fs::path tiles_prefix(const fs::path& folder, std::size_t level) {
  return folder / (std::string(kTiles) + std::to_string(level) + "-");
}

std::vector<fs::path> workspace_files(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!PartReader::is_part(folder / kRun)) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (fs::is_regular_file(entry.symlink_status()) && is_workspace_name(entry.path().filename().string()))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::optional<WorkspaceState> state_of_workspace(const fs::path& folder) {
  const std::vector<fs::path> files = workspace_files(folder);
  if (files.empty()) return std::nullopt;
  WorkspaceState state{.made_from = lines_of(folder).value_or(Lines{})};
  std::map<std::size_t, LevelState> levels;
  std::map<std::size_t, std::set<std::uint64_t>> evaluated;  // tiles, by level
  for (const fs::path& file : files) {
    std::error_code error;
    if (const std::uintmax_t bytes = fs::file_size(file, error); !error) state.bytes += bytes;
    const std::string name = file.filename().string();
    const bool is_level = name.starts_with(kLevel), has_dot = file.has_extension();
    if (has_dot || !(is_level || name.starts_with(kTiles))) continue;
    const std::optional<PartReader> part = PartReader::open_unchecked(file);
    if (!part) continue;
    const std::size_t number = std::stoul(name.substr(kLevel.size()));
    LevelState& level = levels[number];
    level.number = number;
    if (is_level) {
      for (const Tile& tile : part->records<Tile>("tiles", 0)) ++level.tiles, level.points += tile.points;
    } else {
      const std::vector<std::uint64_t> tiles = part->keys();
      evaluated[number].insert(tiles.begin(), tiles.end());
    }
  }
  for (auto& [number, level] : levels) {
    level.evaluated = evaluated[number].size();
    state.levels.push_back(level);
  }
  return state;
}

void remove_part(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) throw Error(file.string() + ": cannot be removed: " + error.message());
}

void open_workspace(const PointSource& scan, Job& job) {
  const fs::path folder = job.config.run.workspace;
  if (folder.empty()) return;
  const Lines identity = scan.identity();
  if (identity.empty())
    throw Error(folder.string() + ": no workspace can be kept for points that are not read from files");
  const Lines now = made_from(identity, job.config);
  const std::optional<Lines> before = lines_of(folder);
  if (before && *before != now) {
    throw Error(folder.string() + ": the workspace of another run: \"" + first_other(*before, now) +
                "\" there, \"" + first_other(now, *before) +
                "\" here; allowed: the same input and parameters, another folder, or --restart");
  }
  if (!PartReader::is_part(folder / kRun)) refuse_others(folder);
  for (const fs::path& file : workspace_files(folder)) {
    if (!job.is_unit && file.extension() == kUnsealed) remove_part(file);
  }
  if (!before) {
    std::string inputs;
    for (const std::string& name : scan.names()) inputs += name + '\0';
    Config config = job.config;
    config.run.workspace.clear();  // which may be another path for another machine
    PartWriter part(folder / kRun);
    for (const auto& [stream, text] : {std::pair<std::string_view, std::string>{"made from", joined(now)},
                                       {"inputs", inputs},
                                       {"config", print_config(config)}})
      part.add(stream, 0, std::span<const char>(text));
    part.seal(digest_of(kRun));
  }
  job.kept = folder;
  job.made_from = joined(now);
}

}  // namespace lacuna
