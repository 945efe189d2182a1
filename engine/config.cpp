#include "engine/config.hpp"

#include "engine/config_text.hpp"
#include "engine/criteria/criteria.hpp"
#include "engine/parameter_values.hpp"
#include "engine/run/error.hpp"
#include "engine/run/regular_file.hpp"
#include "engine/unknown_key.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include <toml++/toml.h>

namespace lacuna {
namespace {

constexpr std::size_t kLargestConfigFile = 1 << 20;

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
  template <typename Number>
  void operator()(std::vector<Number>* target) const {
    const toml::array* const array = node.as_array();
    if (!array) refuse(parameter, shown());
    std::vector<Number> numbers(array->size());
    for (std::size_t i = 0; i < numbers.size(); ++i) SetFromToml{parameter, (*array)[i]}(&numbers[i]);
    *target = std::move(numbers);
  }
  void operator()(const NamedValue&) const {
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

std::string read_text(const std::filesystem::path& file) {
  check_regular_file(file, "a config file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file.string() + ": cannot be opened: " + std::strerror(errno));
  std::string text(kLargestConfigFile + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) throw Error(file.string() + ": cannot read the config file: " + std::strerror(errno));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kLargestConfigFile) throw Error(file.string() + ": too large for a config file (1 MiB)");
  return text;
}

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

// Min along each axis, then max along each.
void check_box(const std::string& name, std::span<const double> box) {
  const std::size_t axes = box.size() / 2;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    if (box[axis] > box[axes + axis])
      throw Error(name + " are empty: min " + std::string(1, "xyz"[axis]) + " = " + print_number(box[axis]) +
                  " is above max " + "xyz"[axis] + " = " + print_number(box[axes + axis]) +
                  "; all of min come before all of max");
  }
}

void check_boxes(const InputConfig& input) {
  const std::vector<double>& bounds = input.bounds;
  if (!bounds.empty() && bounds.size() != 4 && bounds.size() != 6)
    throw Error("bounds has " + std::to_string(bounds.size()) +
                " numbers; allowed: 4 (min x y, max x y) or 6 (min x y z, max x y z), divided by commas");
  check_box("bounds", bounds);
  const std::span<const double> boxes = input.leave_out;
  if (boxes.size() % 6 != 0)
    throw Error("leave_out has " + std::to_string(boxes.size()) +
                " numbers; allowed: 6 for each box (min x y z, max x y z), divided by commas");
  for (std::size_t at = 0; at < boxes.size(); at += 6) check_box("boxes of leave_out", boxes.subspan(at, 6));
}

// A report is put together in memory, and GDAL has memory of its own. Measured beyond the rest: 21 and 30
// MiB.
void check_memory_of_outputs(const OutputConfig& output, std::uint64_t memory_limit) {
  constexpr std::uint64_t kMiB = 1 << 20, kLeast = 64, kReport = 32, kGis = 48;
  const bool is_gis = output.gpkg || output.geojson || output.shp;
  const std::uint64_t least = kLeast + (output.report ? kReport : 0) + (is_gis ? kGis : 0);
  if (memory_limit == 0 || memory_limit >= least * kMiB) return;
  const std::string outputs = output.report && is_gis ? "a report and files for GIS"
                              : is_gis                ? "files for GIS"
                                                      : "a report";
  throw Error("memory_limit = " + std::to_string(memory_limit / kMiB) + "MiB is too little for " + outputs +
              "; allowed: at least " + std::to_string(least) + "MiB");
}

}  // namespace

std::vector<std::string> read_config(const std::filesystem::path& file, Config& config) {
  return read_config_text(read_text(file), file, config);
}

std::vector<std::string> read_config_text(const std::string& text, const std::filesystem::path& file,
                                          Config& config) {
  Config changed = config;
  std::vector<std::string> keys;
  const std::vector<Parameter> all = parameters(changed);
  const toml::table root = parse_toml(file, text);
  const auto fail = [&file](const toml::source_region& place, const std::string& reason) {
    throw Error(file.string() + ":" + std::to_string(place.begin.line) + ": " + reason);
  };

  for (const auto& [section, content] : root) {
    const toml::table* table = content.as_table();
    if (!table || !is_section(all, section.str())) {
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

double first_edge(const ScaleConfig& scale) {
  if (scale.resolution > 0 || scale.every_point) return scale.resolution;
  return scale.min_hole / kCellsAcross;
}

Config with_min_hole(Config config) {
  if (config.selection.min_diameter == 0) config.selection.min_diameter = config.scale.min_hole;
  return config;
}

void check_config(const Config& config) {
  Config checked = config;
  for (const Parameter& parameter : parameters(checked)) {
    std::visit(
        [&parameter](const auto& value) {
          if constexpr (requires { static_cast<double>(*value); }) {
            if (!in_range(parameter, static_cast<double>(*value))) refuse(parameter, parameter.print());
          }
        },
        parameter.value);
  }

  check_boxes(config.input);
  const NeighbourhoodConfig& neighbourhood = config.neighbourhood;
  if (neighbourhood.eps > 0 && neighbourhood.eps_fraction > 0) {
    throw Error("eps and eps_fraction are both set; allowed: at most one of them above 0");
  }
  const std::vector<double>& weights = config.criteria.weights;
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; })) {
    std::string names;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (i > 0) names += i + 1 < weights.size() ? ", " : " and ";
      names += criteria()[i].weight_key;
    }
    throw Error(names + " are all 0; allowed: at least one above 0");
  }
  check_memory_of_outputs(config.output, config.run.memory_limit);
  const SelectionConfig& selection = config.selection;
  if (selection.max_perimeter > 0 && selection.max_perimeter < selection.min_perimeter) {
    throw Error("max_perimeter = " + print_number(selection.max_perimeter) +
                " is less than min_perimeter = " + print_number(selection.min_perimeter) +
                "; allowed: 0 (no limit) or at least min_perimeter");
  }
}

}  // namespace lacuna
