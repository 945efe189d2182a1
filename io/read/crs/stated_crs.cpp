// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/stated_crs.hpp"

#include "engine/run/error.hpp"
#include "io/read/crs/crs_text.hpp"
#include "io/read/crs/gis_module.hpp"
#include "io/read/crs/length_unit.hpp"
#include "io/read/files/input_file.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include <spdlog/spdlog.h>

namespace lacuna::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBlanks = " \t\r\n";

std::string trimmed(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == text.npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin));
}

// Returns the name for messages: for well-known text the beginning, in one line.
std::string shown(const std::string& given) {
  constexpr std::size_t kMost = 60;
  const std::string text = trimmed(given);
  const std::size_t end =
      std::min(text.find_first_of("\r\n"), text.find('[') == text.npos ? text.npos : kMost);
  return end < text.size() ? text.substr(0, end) + "..." : text;
}

// Returns the text of a .prj or .wkt file if the given text names a file.
std::string text_of(const std::string& given) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20;
  std::error_code error;
  if (!fs::exists(given, error)) return trimmed(given);
  InputFile in(given, kMostBytes);
  if (in.remaining() >= kMostBytes) in.fail("too large for a coordinate reference system (1 MiB)");
  return trimmed(in.peek(kMostBytes));
}

[[noreturn]] void refuse_crs(const std::string& given, const std::string& reason) {
  throw Error("--crs " + shown(given) + ": " + reason +
              "; allowed: a code such as EPSG:25832, well-known text of a system of positions, or a file "
              "that has one of them");
}

// Returns what GDAL knows of a system; nothing without lacuna_gis.so.
std::optional<CrsLookup> ask_gdal(const std::string& crs) {
  auto* const look_up_crs = reinterpret_cast<LookUpCrs*>(find_gis_function(kLookUpCrs));
  if (look_up_crs == nullptr) return std::nullopt;
  CrsLookup lookup{.given = crs, .known_text = {}, .reason = {}};
  look_up_crs(lookup);
  return lookup;
}

// Returns the system as well-known text.
std::string look_up(const std::string& given, const std::string& text) {
  if (!is_code(text) && horizontal_system(text).empty())
    refuse_crs(given, "is no coordinate reference system");
  const std::optional<CrsLookup> lookup = ask_gdal(text);
  if (!lookup) {
    spdlog::warn("--crs {}: is not checked, since lacuna_gis.so is missing{}", shown(given),
                 is_code(text) ? "; results have the code alone, and no unit unless --unit states it" : "");
    return text;
  }
  if (lookup->known_text.empty())
    refuse_crs(given,
               "GDAL knows no such system" + (lookup->reason.empty() ? "" : " (" + lookup->reason + ")"));
  if (horizontal_system(lookup->known_text).empty()) refuse_crs(given, "is no system of positions");
  return is_code(text) ? lookup->known_text : text;
}

}  // namespace

StatedCrs read_stated_crs(const InputConfig& config) {
  StatedCrs stated;
  if (!config.crs.empty()) stated.crs = look_up(config.crs, text_of(config.crs));
  stated.unit = length_unit(stated.crs);
  stated.unit_z =
      config.unit_z == LengthUnit::kInput ? vertical_unit(stated.crs) : std::string(name_of(config.unit_z));
  if (config.unit == LengthUnit::kInput) return stated;
  const std::string unit(name_of(config.unit));
  if (!stated.unit.empty() && stated.unit != unit)
    throw Error("--unit " + unit + ": contradicts --crs " + shown(config.crs) + ", which has lengths in " +
                stated.unit + "; one of the two is enough");
  stated.unit = unit;
  return stated;
}

std::string known_text(const std::string& crs) {
  if (!is_code(crs)) return crs;
  const std::optional<CrsLookup> lookup = ask_gdal(crs);
  if (!lookup) return "";
  const std::string flat(without_vertical(crs));
  return lookup->known_text.empty() && flat != crs ? known_text(flat) : lookup->known_text;
}

std::optional<ProjectionScale> scale_at(const std::string& crs, const Eigen::Vector3d& place) {
  // GDAL takes 70 ms and 35 MiB, which most scans can do without: within this strip UTM is true to 1 in 300.
  if (is_utm(crs) && place.x() > 0 && place.x() < 1e6) return std::nullopt;
  auto* const find_scale = reinterpret_cast<FindScale*>(find_gis_function(kFindScale));
  ProjectionScale scale;
  if (crs.empty() || find_scale == nullptr || !find_scale(crs, place, scale)) return std::nullopt;
  return scale;
}

bool is_same_crs(const std::string& a, const std::string& b) {
  if (a == b || a.empty() || b.empty()) return a == b;
  auto* const is_same = reinterpret_cast<IsSameCrs*>(find_gis_function(kIsSameCrs));
  return is_same != nullptr && is_same(a, b);
}

}  // namespace lacuna::io
