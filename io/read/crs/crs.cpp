// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/crs.hpp"

#include "engine/run/error.hpp"
#include "io/read/files/input_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <mutex>
#include <system_error>

#include <dlfcn.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

namespace lacuna::io {
namespace {

struct Unit {
  const char* name;
  double metres;
};

constexpr Unit kUnits[] = {{"m", 1},       {"km", 1000},   {"cm", 0.01},
                           {"mm", 0.001},  {"ft", 0.3048}, {"us-ft", 1200.0 / 3937},
                           {"in", 0.0254}, {"yd", 0.9144}};

}  // namespace

std::string unit_of_metres(double metres) {
  constexpr double kTolerance = 1e-7;  // the two feet differ by 2e-6
  const auto* const unit = std::find_if(std::begin(kUnits), std::end(kUnits), [&](const Unit& known) {
    return std::abs(metres / known.metres - 1) < kTolerance;
  });
  return unit == std::end(kUnits) ? "" : unit->name;
}

std::optional<double> metres_of_unit(std::string_view unit) {
  const auto* const known = std::find_if(std::begin(kUnits), std::end(kUnits),
                                         [&](const Unit& other) { return unit == other.name; });
  return known == std::end(kUnits) ? std::nullopt : std::optional(known->metres);
}

namespace {

namespace fs = std::filesystem;

// Returns the folder of the program, or of the library that holds this code, such as a module of Python.
fs::path own_folder() {
  Dl_info self{};
  const bool is_known = ::dladdr(reinterpret_cast<const void*>(&own_folder), &self) != 0;
  const fs::path file = is_known ? self.dli_fname : "";
  std::error_code error;
  // A program's name may be anything; a library's name may end with its version.
  const bool is_library = file.is_absolute() && file.filename().string().find(".so") != std::string::npos;
  return (is_library ? file : fs::read_symlink("/proc/self/exe", error)).parent_path();
}

fs::path find_module(const char* user) {
  std::error_code error;
  const fs::path folder = own_folder();
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path installed = program.parent_path() / "lib" / "lacuna";
  // The shared library lies in lib, or in lib/x86_64-linux-gnu.
  for (const fs::path& place : {folder, installed, folder / "lacuna", folder.parent_path() / "lacuna"}) {
    if (fs::exists(place / "lacuna_gis.so", error)) return place / "lacuna_gis.so";
  }
  throw Error("lacuna_gis.so: is neither in " + folder.string() + " nor in " + installed.string() + "; " +
              user + " need it");
}

}  // namespace

void check_gis_module(const char* user) {
  find_module(user);
}

void* load_gis_function(const char* name, const char* user) {
  const fs::path file = find_module(user);
  void* const module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) throw Error(file.string() + ": cannot be loaded: " + ::dlerror());
  void* const function = ::dlsym(module, name);
  if (function == nullptr) throw Error(file.string() + ": is not of this version of lacuna");
  return function;
}

void* find_gis_function(const char* name) {
  try {
    return load_gis_function(name, "");
  } catch (const Error&) {
    return nullptr;
  }
}

bool is_code(std::string_view text) {
  const std::size_t colon = text.find(':');
  return colon != text.npos && colon > 0 && colon + 1 < text.size() &&
         text.find_first_not_of("0123456789+", colon + 1) == text.npos &&
         std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isalpha(c) != 0; });
}

bool is_utm_code(std::string_view crs) {
  constexpr std::string_view kEpsg = "EPSG:";
  constexpr std::array<std::array<int, 2>, 4> kZones = {
      {{32601, 32660}, {32701, 32760}, {25828, 25838}, {26901, 26923}}};  // WGS 84, ETRS89, NAD83
  int code = 0;
  if (!crs.starts_with(kEpsg)) return false;
  const auto end = std::from_chars(crs.data() + kEpsg.size(), crs.data() + crs.size(), code).ptr;
  return end == crs.data() + crs.size() && std::any_of(kZones.begin(), kZones.end(), [&](const auto& zones) {
           return code >= zones[0] && code <= zones[1];
         });
}

std::string name_of_crs(const std::string& crs) {
  const std::size_t begin = crs.find('"'), end = crs.find('"', begin + 1);
  return end == crs.npos ? crs : crs.substr(begin + 1, end - begin - 1);
}

const CrsFacts& facts_of(const std::string& crs) {
  static std::mutex mutex;
  static std::map<std::string, CrsFacts> known;
  const std::lock_guard lock(mutex);
  const auto [place, is_new] = known.try_emplace(crs);
  if (!is_new || crs.empty()) return place->second;
  auto* const look_up_crs = reinterpret_cast<LookUpCrs*>(find_gis_function(kLookUpCrs));
  if (look_up_crs != nullptr) look_up_crs(crs, place->second);
  return place->second;
}

std::string length_unit(const std::string& crs) {
  return is_utm_code(crs) ? "m" : unit_of_metres(facts_of(crs).metres);
}

std::string vertical_unit(const std::string& crs) {
  return is_utm_code(crs) ? "" : unit_of_metres(facts_of(crs).metres_of_z);
}

std::string without_vertical(const std::string& crs) {
  if (is_code(crs)) return crs.substr(0, crs.find('+'));
  const CrsFacts& facts = facts_of(crs);
  return facts.metres_of_z == 0 ? crs : facts.horizontal;
}

namespace {

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

// Returns the system as well-known text.
std::string look_up(const std::string& given, const std::string& text) {
  if (!is_code(text) && text.find_first_of("[(") == text.npos)
    refuse_crs(given, "is no coordinate reference system");
  if (find_gis_function(kLookUpCrs) == nullptr) {
    spdlog::warn("--crs {}: is not checked, since lacuna_gis.so is missing; results have the {} alone{}",
                 shown(given), is_code(text) ? "code" : "text",
                 is_utm_code(text) ? "" : ", and no unit unless --unit states it");
    return text;
  }
  const CrsFacts& facts = facts_of(text);
  if (!facts.is_whole)
    refuse_crs(given, "GDAL knows no such system" + (facts.reason.empty() ? "" : " (" + facts.reason + ")"));
  if (!facts.has_positions) refuse_crs(given, "is no system of positions");
  return is_code(text) ? facts.known_text : text;
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

std::optional<ProjectionScale> scale_at(const std::string& crs, const Eigen::Vector3d& place) {
  // GDAL takes 70 ms and 35 MiB, which some scans can do without: within this strip UTM is true to 1 in 300.
  if (is_utm_code(crs) && place.x() > 0 && place.x() < 1e6) return std::nullopt;
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

std::optional<std::vector<Eigen::Vector3d>> to_degrees(const std::string& crs,
                                                       std::vector<Eigen::Vector3d> places,
                                                       const std::filesystem::path& file) {
  if (crs.empty()) return std::nullopt;
  auto* const convert = reinterpret_cast<ConvertToDegrees*>(find_gis_function(kConvertToDegrees));
  const Eigen::Vector3d first = places.empty() ? Eigen::Vector3d(0, 0, 0) : places.front();
  if (convert != nullptr && convert(crs, places)) {
    if (!places.empty()) warn_of_accuracy(crs, first, file);
    return places;
  }
  spdlog::warn("{}: {}; GIS will read its coordinates, which are those of the scan, as degrees",
               file.string(),
               convert == nullptr ? "lacuna_gis.so is missing, which converts to longitude and latitude"
                                  : "GDAL cannot convert the coordinate reference system of the scan to "
                                    "longitude and latitude there");
  return std::nullopt;
}

std::string ConversionAccuracy::print() const {
  const std::string error =
      std::isfinite(metres) ? fmt::format("to {:g} m only", metres) : "with an error that is not known";
  if (missing_grid.empty()) return error;
  return fmt::format("{}; PROJ does not find the grid {}, which gives {:g} m", error, missing_grid,
                     with_grid);
}

void warn_of_accuracy(const std::string& crs, const Eigen::Vector3d& place,
                      const std::filesystem::path& file) {
  constexpr double kMetre = 1;
  auto* const find = reinterpret_cast<FindDegreesAccuracy*>(find_gis_function(kFindDegreesAccuracy));
  ConversionAccuracy accuracy;
  if (find == nullptr || !find(crs, place, accuracy)) return;
  if (accuracy.moves_datum && accuracy.metres > kMetre)
    spdlog::warn("{}: longitude and latitude hold {}", file.string(), accuracy.print());
}

}  // namespace lacuna::io
