// SPDX-License-Identifier: Apache-2.0
#include "io/las/las_join.hpp"

#include "engine/run/error.hpp"
#include "io/las/las_scale.hpp"
#include "io/little_endian.hpp"
#include "io/property_name.hpp"
#include "io/scalar.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace lacuna::io {
namespace {

constexpr const char* kWayOut = "; --points-format ply holds them all";

bool has_standard_time(const LasHeader& header) {
  const bool has_encoding = header.minor >= 2;
  return has_encoding && (load<std::uint16_t>(&header.bytes[6]) & 1u) != 0;
}

// Returns the first one with GPS times, if there is one.
const LasPart* check_fields(const std::vector<LasPart>& parts) {
  const LasPart* timed = nullptr;
  for (const LasPart& part : parts) {
    const LasGroups groups = las_groups(part.header.point_format);
    if (groups.waveform && &part != &parts.front())
      throw Error(part.name + ": its waveforms cannot join those of the first file in one LAS file" +
                  kWayOut);
    if (!groups.gps_time) continue;
    if (timed == nullptr) timed = &part;
    if (has_standard_time(part.header) != has_standard_time(timed->header))
      throw Error(part.name + ": its GPS times are of another kind than those of " + timed->name +
                  ", and a LAS file has one kind" + kWayOut);
  }
  return timed;
}

// Which column of the others becomes this field; none: nothing of that name fits it.
struct Match {
  std::size_t column;
  double factor;
};

bool fits(const ImportedColumn& column, const LasField& field) {
  if (field.type == Scalar::kFloat64) return true;
  // Degrees, or steps of 0.006: only the type says which.
  if (std::string_view(field.name) == "scan_angle") return column.property.type == field.type;
  double most = field.type == Scalar::kUint16 ? 65535 : 255;
  if (field.bits > 0) most = static_cast<double>((1u << field.bits) - 1);
  return column.is_whole && !(column.min < 0) && !(column.max > most);
}

std::optional<std::size_t> find_column(const std::vector<ImportedColumn>& columns, const char* name) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string& given = columns[i].property.name;
    const bool has_number = given.find_first_of("0123456789") != given.npos;
    if (!has_number && bare_name(given) == bare_name(name)) return i;
  }
  return std::nullopt;
}

// Bytes, or numbers of a text that could be bytes.
bool is_of_bytes(const ImportedColumn& column) {
  const Scalar type = column.property.type;
  return type == Scalar::kUint8 || (!is_integer(type) && column.max <= 255);
}

// For each column of the others, the field that it becomes.
std::vector<ImportedField> match_fields(const std::vector<ImportedColumn>& columns, bool is_extended) {
  std::vector<ImportedField> imported;
  for (const ImportedColumn& column : columns)
    imported.push_back({.from = column.property, .field = {}, .extra = 0, .factor = 1});
  bool has_colour = true, is_dark = true;
  std::vector<std::pair<std::size_t, LasField>> colours;
  for (const LasField& field : las_fields(is_extended ? 8 : 3)) {
    const std::string_view name = field.name;
    const bool is_colour = name == "red" || name == "green" || name == "blue";
    const auto found = find_column(columns, field.name);
    const bool is_match = found && fits(columns[*found], field);
    if (is_colour) {
      has_colour = has_colour && is_match;
      if (!has_colour) continue;
      is_dark = is_dark && is_of_bytes(columns[*found]);
      colours.emplace_back(*found, field);
    } else if (is_match && (name != "nir" || has_colour)) {
      imported[*found].field = field;
    }
  }
  for (const auto& [column, field] : colours) {
    if (!has_colour) break;
    imported[column].field = field;
    imported[column].factor = is_dark ? 257 : 1;
  }
  std::erase_if(imported, [](const ImportedField& field) {
    return field.from.name == "x" || field.from.name == "y" || field.from.name == "z";
  });
  return imported;
}

// Adds the extra bytes of a file.
void join_extra(std::vector<LasExtraField>& joined, const std::vector<LasExtraBytes>& added,
                const std::string& file) {
  std::set<std::size_t> taken;  // of two equal names, the second is the second one's
  for (const LasExtraBytes& extra : added) {
    std::size_t i = 0;
    while (i < joined.size() && (joined[i].what.name != extra.name || taken.contains(i))) ++i;
    taken.insert(i);
    if (i == joined.size()) {
      joined.push_back({.what = extra, .offset = 0, .bytes = 0});
    } else if (!is_same_kind(joined[i].what, extra)) {
      const bool are_values =
          joined[i].what.type > 0 && joined[i].what.type <= 10 && extra.type > 0 && extra.type <= 10;
      if (!are_values)
        throw Error(file + ": its extra bytes '" + extra.name +
                    "' have another form than those of the files before" + kWayOut);
      joined[i].what = as_double(joined[i].what);
    }
  }
}

std::string file_of_others(const LasParts& parts) {
  return parts.las.empty() ? parts.name : parts.las.front().name;
}

}  // namespace

LasForm join_las(const LasParts& parts) {
  constexpr std::size_t kMostRecordBytes = 65535;
  const LasPart* timed = check_fields(parts.las);
  if (timed == nullptr && !parts.las.empty()) timed = &parts.las.front();
  LasForm form;
  form.keeps_results = parts.keeps_results;
  form.name = parts.name;
  form.has_standard_time = timed != nullptr && has_standard_time(timed->header);
  const bool has_code = parts.crs.starts_with("EPSG:");  // which records for the formats up to 5 name
  bool is_extended = parts.las.empty() && !has_code;
  bool has_time = false, has_colour = false, has_infrared = false, has_waveform = false;
  for (const LasPart& part : parts.las) {
    const LasGroups groups = las_groups(part.header.point_format);
    is_extended = is_extended || is_extended_format(part.header.point_format);
    has_time = has_time || groups.gps_time;
    has_colour = has_colour || groups.colour;
    has_infrared = has_infrared || groups.infrared;
    has_waveform = has_waveform || groups.waveform;
  }
  form.imported = match_fields(parts.imported, is_extended);
  for (const ImportedField& imported : form.imported) {
    if (!imported.field) continue;
    const std::string_view name = imported.field->name;
    has_time = has_time || name == "gps_time";
    has_colour = has_colour || name == "red";
    has_infrared = has_infrared || name == "nir";
  }
  const bool is_single = parts.las.size() == 1 && parts.imported.empty();
  form.point_format = is_single
                          ? parts.las.front().header.point_format
                          : las_format_with(is_extended, has_time, has_colour, has_infrared, has_waveform);
  form.is_as_it_was = is_single && !parts.las.front().has_pose;

  for (const LasPart& part : parts.las) {
    std::vector<LasExtraBytes> extra = las_extra_of_points(part.header);
    if (!parts.keeps_results) std::erase_if(extra, is_lacuna_extra);
    join_extra(form.extra, extra, part.name);
  }
  std::vector<LasExtraBytes> extra;
  std::vector<ImportedField*> columns;
  for (ImportedField& imported : form.imported) {
    if (imported.field) {
      // Its place in the format chosen, where it need not be that of the search.
      for (const LasField& field : las_fields(form.point_format)) {
        if (std::string_view(field.name) == imported.field->name) imported.field = field;
      }
      continue;
    }
    LasExtraBytes made = las_extra_of(imported.from.name, imported.from.type, "");
    const auto is_name = [&](const LasExtraBytes& other) { return other.name == made.name; };
    for (int i = 2; std::any_of(extra.begin(), extra.end(), is_name); ++i) {
      std::string number = "_";
      number += std::to_string(i);
      rename(made, imported.from.name.substr(0, 32 - number.size()) + number);
    }
    extra.push_back(made);
    columns.push_back(&imported);
  }
  join_extra(form.extra, extra, file_of_others(parts));
  for (std::size_t i = 0; i < extra.size(); ++i) {
    const auto is_name = [&](const LasExtraField& field) { return field.what.name == extra[i].name; };
    columns[i]->extra = static_cast<std::size_t>(std::find_if(form.extra.begin(), form.extra.end(), is_name) -
                                                 form.extra.begin());
  }

  form.record_bytes = las_point_bytes(form.point_format);
  for (LasExtraField& field : form.extra) {
    if (!is_single) forget_range(field.what);
    field.offset = form.record_bytes;
    field.bytes = las_extra_size(field.what);
    form.record_bytes += field.bytes;
  }
  if (form.record_bytes > kMostRecordBytes)
    throw Error(file_of_others(parts) + ": points of " + std::to_string(form.record_bytes) +
                " bytes, and LAS has at most " + std::to_string(kMostRecordBytes) + kWayOut);
  const LasScale scale = join_scales(parts);
  form.scale = scale.scale;
  form.offset = scale.offset;
  return form;
}

}  // namespace lacuna::io
