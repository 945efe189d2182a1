#include "engine/config.hpp"

#include "engine/config_text.hpp"
#include "engine/run/error.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>

#include <toml++/toml.h>

namespace lacuna {
namespace {

constexpr std::uint64_t kKiB = 1024;
constexpr std::uint64_t kMiB = 1024 * kKiB;
constexpr std::uint64_t kGiB = 1024 * kMiB;
constexpr std::uint64_t kTiB = 1024 * kGiB;
constexpr std::uint64_t kLeastMemory = 64 * kMiB;
constexpr std::size_t kLargestConfigFile = 1 << 20;
constexpr double kAboveZero = std::numeric_limits<double>::min();

// In the order of LoopMethod.
constexpr std::string_view kMethods[] = {"tangential", "paper"};
constexpr std::string_view kFormerTangential = "stars";

struct Unit {
  std::string_view name;
  std::uint64_t bytes;
};

constexpr Unit kUnits[] = {
    {"TiB", kTiB},         {"GiB", kGiB},     {"MiB", kMiB}, {"KiB", kKiB}, {"TB", 1'000'000'000'000},
    {"GB", 1'000'000'000}, {"MB", 1'000'000}, {"KB", 1'000}, {"kB", 1'000}, {"B", 1},
};

[[noreturn]] void refuse(const Parameter& parameter, std::string_view given) {
  std::ostringstream message;
  message << parameter.key << " = " << given << " is not possible; allowed: " << parameter.allowed;
  throw Error(message.str());
}

bool in_range(const Parameter& parameter, double value) {
  const bool is_size = std::holds_alternative<std::uint64_t*>(parameter.value);
  if (is_size && value == 0) return true;
  return std::isfinite(value) && parameter.min <= value && value <= parameter.max;
}

std::string print_number(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  std::string text(buffer, end);
  const bool is_whole = text.find_first_not_of("-0123456789") == std::string::npos;
  return is_whole ? text + ".0" : text;  // TOML tells real from whole numbers by the point
}

// A TOML basic string.
std::string quote(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (code < 0x20 || code == 0x7f) {
      constexpr char kDigits[] = "0123456789ABCDEF";
      quoted += "\\u00";
      quoted += kDigits[code >> 4];
      quoted += kDigits[code & 15];
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// Sets values, of whatever type the parameter has, once they are found possible.
struct SetFromText {
  const Parameter& parameter;
  std::string_view text;

  template <typename Number>
  void operator()(Number* target) const {
    const std::optional<Number> number = parse_number<Number>(text);
    if (!number || !in_range(parameter, static_cast<double>(*number))) refuse(parameter, text);
    *target = *number;
  }
  void operator()(bool* target) const {
    if (text != "true" && text != "false") refuse(parameter, text);
    *target = text == "true";
  }
  void operator()(std::string* target) const { *target = text; }
  void operator()(LoopMethod* target) const {
    const auto method = std::find(std::begin(kMethods), std::end(kMethods), text);
    if (method == std::end(kMethods)) {
      refuse(parameter, text == kFormerTangential ? "stars (now called tangential)" : text);
    }
    *target = static_cast<LoopMethod>(method - std::begin(kMethods));
  }
  void operator()(std::uint64_t* target) const {
    std::uint64_t bytes = 0;
    try {
      bytes = parse_bytes(text);
    } catch (const Error&) {
      refuse(parameter, text);
    }
    if (!in_range(parameter, static_cast<double>(bytes))) refuse(parameter, text);
    *target = bytes;
  }
};

struct SetFromToml {
  const Parameter& parameter;
  const toml::node& node;

  void operator()(std::int64_t* target) const { set_number(target, node.value_exact<std::int64_t>()); }
  void operator()(double* target) const {
    set_number(target, node.is_number() ? node.value<double>() : std::nullopt);
  }
  void operator()(bool* target) const {
    const auto flag = node.value_exact<bool>();
    if (!flag) refuse(parameter, shown());
    *target = *flag;
  }
  void operator()(std::string* target) const {
    const auto text = node.value_exact<std::string>();
    if (!text) refuse(parameter, shown());
    *target = *text;
  }
  void operator()(LoopMethod*) const {
    const auto text = node.value_exact<std::string>();
    if (!text) refuse(parameter, shown());
    parameter.set(*text);
  }
  void operator()(std::uint64_t*) const {
    if (const auto text = node.value_exact<std::string>()) {
      parameter.set(*text);
    } else if (node.is_integer()) {
      parameter.set(shown());
    } else {
      refuse(parameter, shown());
    }
  }

 private:
  template <typename Number>
  void set_number(Number* target, std::optional<Number> number) const {
    if (!number || !in_range(parameter, static_cast<double>(*number))) refuse(parameter, shown());
    *target = *number;
  }
  std::string shown() const {
    if (node.is_table()) return "{...}";
    if (node.is_array()) return "[...]";
    if (const auto text = node.value_exact<std::string>()) return quote(*text);
    std::ostringstream out;
    node.visit([&out](const auto& value) { out << value; });
    return out.str();
  }
};

struct PrintValue {
  std::string operator()(const std::int64_t* value) const { return std::to_string(*value); }
  std::string operator()(const double* value) const { return print_number(*value); }
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const std::string* value) const { return quote(*value); }
  std::string operator()(const std::uint64_t* value) const { return quote(print_bytes(*value)); }
  std::string operator()(const LoopMethod* value) const { return quote(name_of(*value)); }
};

// Number of outbox to insert, remove or replace to turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

// " (did you mean "k"?)" where one of the words is close, else nothing.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& words) {
  std::string_view closest;
  std::size_t least = 3;  // a swap of two outbox costs 2
  for (const std::string_view candidate : words) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      closest = candidate;
    }
  }
  return closest.empty() ? "" : " (did you mean \"" + std::string(closest) + "\"?)";
}

std::string join(const std::vector<std::string_view>& words) {
  std::string joined;
  for (const std::string_view word : words) {
    if (!joined.empty()) joined += ", ";
    joined += word;
  }
  return joined;
}

std::vector<std::string_view> section_names(const std::vector<Parameter>& all) {
  std::vector<std::string_view> names;
  for (const Parameter& parameter : all) {
    if (names.empty() || names.back() != parameter.section) names.push_back(parameter.section);
  }
  return names;
}

std::vector<std::string_view> key_names(const std::vector<Parameter>& all, std::string_view section) {
  std::vector<std::string_view> names;
  for (const Parameter& parameter : all) {
    if (parameter.section == section) names.push_back(parameter.key);
  }
  return names;
}

const Parameter* find_key(const std::vector<Parameter>& all, std::string_view key) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.key == key; });
  return found == all.end() ? nullptr : &*found;
}

std::string belongs_in(const Parameter& parameter) {
  return "\"" + std::string(parameter.key) + "\" belongs in [" + std::string(parameter.section) + "]";
}

std::string unknown_key(const std::vector<Parameter>& all, std::string_view section, std::string_view key) {
  const std::vector<std::string_view> keys = key_names(all, section);
  const Parameter* elsewhere = find_key(all, key);
  const std::string hint = elsewhere ? " (" + belongs_in(*elsewhere) + ")" : suggestion(key, keys);
  return "unknown key \"" + std::string(key) + "\" in [" + std::string(section) + "]" + hint +
         "; allowed there: " + join(keys);
}

std::string unknown_section(const std::vector<Parameter>& all, std::string_view name, bool is_table) {
  const std::vector<std::string_view> sections = section_names(all);
  const std::string quoted = "\"" + std::string(name) + "\"";
  if (is_table) {
    return "unknown section " + quoted + suggestion(name, sections) + "; allowed: " + join(sections);
  }
  const Parameter* parameter = find_key(all, name);
  const std::string hint = parameter ? " (" + belongs_in(*parameter) + ")" : "";
  return "key " + quoted + " stands outside of a section" + hint + "; allowed: " + join(sections);
}

std::string read_text(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw Error(file.string() + ": a folder, not a config file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file.string() + ": cannot open the config file: " + std::strerror(errno));
  std::string text(kLargestConfigFile + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) throw Error(file.string() + ": cannot read the config file: " + std::strerror(errno));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kLargestConfigFile) throw Error(file.string() + ": too large for a config file (1 MiB)");
  return text;
}

// ---- What parameters need

constexpr Need kNothing{"", [](const Config&) { return true; }};
constexpr Need kTangential{"--method tangential",
                           [](const Config& c) { return c.loops.method == LoopMethod::kTangential; }};
constexpr Need kPaper{"--method paper", [](const Config& c) { return c.loops.method == LoopMethod::kPaper; }};
constexpr Need kPoints{"--points", [](const Config& c) { return c.output.points; }};
constexpr Need kPointsNormals{"--points --normals",
                              [](const Config& c) { return c.output.points && c.output.normals; }};

toml::table parse_toml(const std::filesystem::path& file, const std::string& text) {
  if (const auto fault = find_fault(text)) {
    throw Error(file.string() + ":" + std::to_string(fault->line) + ": " + fault->reason);
  }
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    throw Error(file.string() + ":" + std::to_string(error.source().begin.line) + ": " +
                std::string(error.description()));
  }
}

}  // namespace

std::string_view name_of(LoopMethod method) {
  return kMethods[static_cast<std::size_t>(method)];
}

std::vector<Parameter> parameters(Config& config) {
  auto& [neighbourhood, normals, criteria, coherence, loops, spanning, tangential, selection, input, output,
         run] = config;
  const double below_90 = std::nextafter(90.0, 0.0);
  return {
      {"neighbourhood", "k", &neighbourhood.k, 1, 1000, "a whole number from 1 to 1000",
       "Nearest neighbours of a point, before the neighbourhoods are made symmetric.", kNothing},
      {"neighbourhood", "eps", &neighbourhood.eps, 0, 1e150, "a length of 0 (off) or more",
       "Radius, in units of the scan, within which every point is a neighbour too.", kNothing},
      {"neighbourhood", "eps_fraction", &neighbourhood.eps_fraction, 0, 1, "a number from 0 (off) to 1",
       "The same radius as a fraction of the bounding box's diagonal; set at most one of the two.", kNothing},

      {"normals", "crease_threshold", &normals.crease_threshold, 0, 1, "a number from 0 to 1",
       "Angle probability above which an estimated normal is turned at a crease.", kNothing},
      {"normals", "orient_normals", &normals.orient, 0, 1, "true or false",
       "Orient normals consistently, by minimum spanning tree.", kPointsNormals},

      {"criteria", "sigma", &criteria.sigma, kAboveZero, 1000, "a number above 0, at most 1000",
       "Width of the Gauss weights, as a multiple of a point's mean distance to its neighbours.", kNothing},
      {"criteria", "cone", &criteria.cone, 0, below_90, "degrees from 0 (off) to less than 90",
       "Angle around the normal line within which directions to neighbours are not used.", kNothing},
      {"criteria", "weight_angle", &criteria.weight_angle, 0, 1e6, "a number from 0 to 1000000",
       "Share of the angle criterion; the three weights are divided by their sum.", kNothing},
      {"criteria", "weight_halfdisc", &criteria.weight_halfdisc, 0, 1e6, "a number from 0 to 1000000",
       "Share of the halfdisc criterion.", kNothing},
      {"criteria", "weight_shape", &criteria.weight_shape, 0, 1e6, "a number from 0 to 1000000",
       "Share of the shape criterion; more of it for noisy scans.", kNothing},

      {"coherence", "threshold", &coherence.threshold, 0, 1, "a number from 0 to 1",
       "Boundary probability above which a point is a candidate; tangential loops are searched from these.",
       kNothing},

      {"loops", "method", &loops.method, 0, 1, "tangential or paper",
       "How loops are found: tangential, as the boundary of the triangles on which neighbouring points "
       "agree; "
       "paper, as Bendels et al. do.",
       kNothing},

      {"spanning", "max_prob_weight", &spanning.max_prob_weight, 0, 1e9, "a number from 0 to 1000000000",
       "Method paper: an edge takes part if its probability weight is below this.", kPaper},
      {"spanning", "max_total_weight", &spanning.max_total_weight, 0, 1e9, "a number from 0 to 1000000000",
       "Method paper: an edge takes part if its total weight is below this.", kPaper},
      {"spanning", "e", &spanning.e, 0, 1e9, "a whole number from 0 (automatic) to 1000000000",
       "Method paper: loops have more than this many edges; 0: round(2 sqrt(pi K)), K the mean number of "
       "neighbours.",
       kPaper},

      {"tangential", "max_radius", &tangential.max_radius, 0.5, 4, "a number from 0.5 to 4",
       "Largest circumradius of a triangle, in medians of those around it; their spread is added.",
       kTangential},
      {"tangential", "hole_radius", &tangential.hole_radius, 0.1, 4, "a number from 0.1 to 4",
       "Circumradius above which a circle lies in a hole, in mean distances to neighbours; medians leave it "
       "out.",
       kTangential},
      {"tangential", "most_radius", &tangential.most_radius, 0.1, 1, "a number from 0.1 to 1",
       "Bound of the median circumradius and of the spread, in mean distances to neighbours.", kTangential},
      {"tangential", "least_spread", &tangential.least_spread, 0.001, 10, "a number from 0.001 to 10",
       "Share of the median circumradius that is added to the spread where excess radii are counted.",
       kTangential},
      {"tangential", "clear_excess", &tangential.clear_excess, 0.001, 1000, "a number from 0.001 to 1000",
       "Excess radius, in spreads, with which a point counts fully for a loop's confidence.", kTangential},
      {"tangential", "doubt", &tangential.doubt, 0, 1000, "a number from 0 to 1000",
       "Points without excess radius that confidence adds to each boundary curve.", kTangential},
      {"tangential", "min_curve", &tangential.min_curve, 3, 1e9, "a whole number from 3 to 1000000000",
       "Boundary curves with fewer points are no loops.", kTangential},

      {"selection", "min_confidence", &selection.min_confidence, 0, 1, "a number from 0 to 1",
       "Loops with a lower confidence are not reported.", kTangential},
      {"selection", "min_perimeter", &selection.min_perimeter, 0, 1e300, "a length of 0 or more",
       "Loops with a smaller perimeter are not reported.", kNothing},
      {"selection", "max_perimeter", &selection.max_perimeter, 0, 1e300, "a length of 0 (no limit) or more",
       "Loops with a larger perimeter are not reported; 0: no limit.", kNothing},
      {"selection", "min_points", &selection.min_points, 0, 1e15, "a whole number from 0 to 10^15",
       "Loops with fewer points are not reported.", kNothing},
      {"selection", "holes_only", &selection.holes_only, 0, 1, "true or false",
       "Report holes only, not the outer rims of open surfaces.", kNothing},

      {"input", "columns", &input.columns, 0, 0, "column names, separated by spaces",
       "Names of a text file's columns, such as x y z nx ny nz; empty: from its header line.", kNothing},

      {"output", "points", &output.points, 0, 1, "true or false",
       "Write points.ply too: every point of the input with its probabilities.", kNothing},
      {"output", "vdb", &output.vdb, 0, 1, "true or false",
       "Write probability.vdb too: the boundary probability as a grid of OpenVDB, for Houdini and Blender.", kNothing},
      {"output", "normals", &output.normals, 0, 1, "true or false",
       "Add the estimated normals to points.ply, unless a scan brings its own.", kPoints},

      {"run", "threads", &run.threads, 0, 1024, "a whole number from 0 (one per core) to 1024",
       "Threads at work; 0: one per core.", kNothing},
      {"run", "memory_limit", &run.memory_limit, static_cast<double>(kLeastMemory), 0x1p60,
       "0 (automatic) or a size of at least 64MiB, such as 512MiB, 2GiB or 4000000000",
       "Memory that the run may take; 0: half of the machine's.", kNothing},
      {"run", "tile_points", &run.tile_points, 0, 1e9, "a whole number from 0 (automatic) to 1000000000",
       "Points per tile at most; 0: chosen from threads and memory limit.", kNothing},
      {"run", "workspace", &run.workspace, 0, 0, "the name of a folder",
       "Folder for what does not fit in memory; empty: inside the output folder.", kNothing},
  };
}

std::string Parameter::option() const {
  std::string name = "--" + std::string(key);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::string Parameter::print() const {
  return std::visit(PrintValue{}, value);
}

void Parameter::set(std::string_view text) const {
  std::visit(SetFromText{*this, text}, value);
}

std::vector<std::string> read_config(const std::filesystem::path& file, Config& config) {
  Config changed = config;
  std::vector<std::string> keys;
  const std::vector<Parameter> all = parameters(changed);
  const toml::table root = parse_toml(file, read_text(file));
  const auto fail = [&file](const toml::source_region& place, const std::string& reason) {
    throw Error(file.string() + ":" + std::to_string(place.begin.line) + ": " + reason);
  };

  for (const auto& [section, content] : root) {
    const toml::table* table = content.as_table();
    if (!table || key_names(all, section.str()).empty()) {
      fail(section.source(), unknown_section(all, section.str(), table != nullptr));
    }
    for (const auto& [key, node] : *table) {
      const Parameter* parameter = find_key(all, key.str());
      if (!parameter || parameter->section != section.str()) {
        fail(key.source(), unknown_key(all, section.str(), key.str()));
      }
      try {
        std::visit(SetFromToml{*parameter, node}, parameter->value);
      } catch (const Error& error) {
        fail(key.source(), error.what());
      }
      keys.emplace_back(key.str());
    }
  }
  config = std::move(changed);
  return keys;
}

std::string print_config(const Config& config) {
  Config printed = config;
  std::string text = "# Parameters of a run of lacuna. Command line over config file over defaults.\n";
  std::string_view section;
  for (const Parameter& parameter : parameters(printed)) {
    text += '\n';
    if (parameter.section != section) {
      section = parameter.section;
      text += "[" + std::string(section) + "]\n";
    }
    text += "# " + std::string(parameter.help) + "\n# Allowed: " + std::string(parameter.allowed) + ".\n" +
            std::string(parameter.key) + " = " + parameter.print() + "\n";
  }
  return text;
}

void check_config(const Config& config) {
  Config checked = config;
  for (const Parameter& parameter : parameters(checked)) {
    std::visit(
        [&parameter](const auto* value) {
          if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(*value)>>) {
            if (!in_range(parameter, static_cast<double>(*value))) refuse(parameter, parameter.print());
          }
        },
        parameter.value);
  }

  const NeighbourhoodConfig& neighbourhood = config.neighbourhood;
  if (neighbourhood.eps > 0 && neighbourhood.eps_fraction > 0) {
    throw Error("eps and eps_fraction are both set; allowed: at most one of them above 0");
  }
  const CriteriaConfig& criteria = config.criteria;
  if (criteria.weight_angle + criteria.weight_halfdisc + criteria.weight_shape == 0) {
    throw Error("weight_angle, weight_halfdisc and weight_shape are all 0; allowed: at least one above 0");
  }
  const SelectionConfig& selection = config.selection;
  if (selection.max_perimeter > 0 && selection.max_perimeter < selection.min_perimeter) {
    throw Error("max_perimeter = " + print_number(selection.max_perimeter) +
                " is less than min_perimeter = " + print_number(selection.min_perimeter) +
                "; allowed: 0 (no limit) or at least min_perimeter");
  }
}

std::uint64_t parse_bytes(std::string_view text) {
  const auto fail = [text] {
    throw Error("\"" + std::string(text) +
                "\" is not a size; allowed: a whole number of bytes, or one with " +
                "KiB, MiB, GiB, TiB, KB, MB, GB or TB, such as 512MiB");
  };
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::optional<std::uint64_t> number = parse_number<std::uint64_t>(text.substr(0, digits));
  std::string_view unit_name = text.substr(digits);
  if (unit_name.starts_with(' ')) unit_name.remove_prefix(1);
  const Unit* unit = std::find_if(std::begin(kUnits), std::end(kUnits),
                                  [&](const Unit& known) { return known.name == unit_name; });
  if (!number || (unit == std::end(kUnits) && digits != text.size())) fail();

  const std::uint64_t factor = unit == std::end(kUnits) ? 1 : unit->bytes;
  if (*number > std::numeric_limits<std::uint64_t>::max() / factor) fail();
  return *number * factor;
}

std::string print_bytes(std::uint64_t bytes) {
  for (const Unit& unit : kUnits) {
    const bool is_binary = unit.name.size() == 3;
    if (is_binary && bytes > 0 && bytes % unit.bytes == 0) {
      return std::to_string(bytes / unit.bytes) + std::string(unit.name);
    }
  }
  return std::to_string(bytes);
}

}  // namespace lacuna
