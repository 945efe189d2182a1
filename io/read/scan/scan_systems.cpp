// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/scan_systems.hpp"

#include "engine/run/error.hpp"
#include "io/read/crs/crs_text.hpp"
#include "io/read/crs/length_unit.hpp"

#include <algorithm>
#include <functional>

namespace lacuna::io {
namespace {

// Takes the other unit where there is none, and notes where the two contradict each other.
void take_unit(ScanFile& file, std::string ScanFile::*of, const std::string& other) {
  std::string& unit = file.*of;
  if (unit.empty()) unit = other;
  if (other.empty() || other == unit || !file.contradiction.empty()) return;
  const bool is_flat = of == &ScanFile::unit;
  file.contradiction = std::string("its unit and its system contradict each other: ") +
                       (is_flat ? "lengths" : "heights") + " are in " + unit + " or in " + other + "; " +
                       unit + " holds, and " + (is_flat ? "--unit " : "--unit-z ") + other +
                       " states the other";
}

void complete_units(std::vector<ScanFile>& files) {
  std::string known_crs, text;  // files of one scan have one system, mostly, which is looked up once
  for (ScanFile& file : files) {
    take_unit(file, &ScanFile::unit, file.other_unit);
    const std::string& crs = file.crs;
    if (file.is_geographic) continue;
    const bool is_flat_utm = is_code(crs) && is_utm(crs) && crs.find('+') == crs.npos;
    if (is_code(crs) && !is_flat_utm && crs != known_crs) {
      known_crs = crs;
      text = known_text(crs);
    }
    take_unit(file, &ScanFile::unit, is_flat_utm ? "m" : length_unit(is_code(crs) ? text : crs));
    if (is_code(crs) && !is_flat_utm) take_unit(file, &ScanFile::z_unit, vertical_unit(text));
  }
}

// Returns the first text of a file that is not empty, if the others are the same. Empty if two differ.
template <class Same>
std::string common(const std::vector<ScanFile>& files, std::string ScanFile::*text, const Same& is_same) {
  std::string first;
  for (const ScanFile& file : files) {
    if ((file.*text).empty()) continue;
    if (first.empty()) first = file.*text;
    if (!is_same(file.*text, first)) return "";
  }
  return first;
}

CommonSystem common_system(const StatedCrs& stated, const std::vector<ScanFile>& files) {
  CommonSystem all{stated.crs.empty() ? common(files, &ScanFile::crs, is_same_crs) : stated.crs, stated.unit};
  if (!all.unit.empty()) return all;
  const auto has_crs = [](const ScanFile& file) { return !file.crs.empty(); };
  const auto has_unit = [](const ScanFile& file) { return !file.unit.empty(); };
  const bool differ = all.crs.empty() && std::ranges::any_of(files, has_crs);
  if (!differ || std::ranges::all_of(files, has_unit))
    all.unit = common(files, &ScanFile::unit, std::equal_to<>());
  return all;
}

// Returns whether z has another unit than the vertical part of the system says. A stated unit of x and y that
// is not the file's own is a word against its unit of z, too.
bool choose_z_factor(const InputConfig& config, const StatedCrs& stated, const std::string& common_unit,
                     ScanFile& file) {
  const std::string& flat = !stated.unit.empty() ? stated.unit : file.unit.empty() ? common_unit : file.unit;
  const std::string said = stated.crs.empty() ? file.z_unit : vertical_unit(stated.crs);
  if (!stated.unit_z.empty()) {
    file.z_unit = stated.unit_z;
  } else if (!stated.unit.empty() && stated.unit != file.unit) {
    file.z_unit.clear();
  }
  const bool is_other = said != file.z_unit;
  const auto metres = metres_of_unit(flat), metres_of_z = metres_of_unit(file.z_unit);
  if (config.unit_z != LengthUnit::kInput && !metres)
    throw Error(file.name.string() +
                ": the unit of x and y is not known, into which --unit-z brings z; --unit states it");
  if (flat == file.z_unit || !metres || !metres_of_z) file.z_unit.clear();
  file.z_factor = file.z_unit.empty() ? 1 : *metres_of_z / *metres;
  return is_other || file.z_factor != 1;
}

}  // namespace

CommonSystem choose_systems(const InputConfig& config, const StatedCrs& stated,
                            std::vector<ScanFile>& files) {
  complete_units(files);
  CommonSystem all = common_system(stated, files);
  bool is_any = false;
  for (ScanFile& file : files) is_any = choose_z_factor(config, stated, all.unit, file) || is_any;
  if (is_any) all.crs = std::string(without_vertical(all.crs));
  return all;
}

}  // namespace lacuna::io
