// SPDX-License-Identifier: Apache-2.0
#include "io/read/e57/e57_columns.hpp"

#include "io/read/files/property_name.hpp"
#include "io/read/rows/scalar.hpp"
#include "io/read/rows/vectors.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <unordered_set>
#include <utility>

namespace lacuna::io {
namespace {

constexpr VectorNames kCartesian = {"cartesianX", "cartesianY", "cartesianZ"};
constexpr VectorNames kSpherical = {"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
constexpr VectorNames kNormal = {"normalX", "normalY", "normalZ"};
constexpr VectorNames kPrefixedNormal = {"nor:normalX", "nor:normalY", "nor:normalZ"};

struct Renamed {
  std::string_view field;
  const char* column;
};
constexpr std::array kRenamed = {Renamed{"colorRed", "red"}, Renamed{"colorGreen", "green"},
                                 Renamed{"colorBlue", "blue"}, Renamed{"returnCount", "number_of_returns"}};

// The column of one field.
struct FieldColumn {
  std::string name;
  Scalar type;
  std::int64_t added = 0;
};

bool has_all(const E57Scan& scan, const VectorNames& names) {
  return std::all_of(names.begin(), names.end(), [&](std::string_view name) {
    return std::any_of(scan.fields.begin(), scan.fields.end(),
                       [&](const E57Field& field) { return field.name == name; });
  });
}

const VectorNames& position_names(const E57Scan& scan) {
  return has_all(scan, kCartesian) ? kCartesian : kSpherical;
}

const VectorNames* normal_names(const E57Scan& scan) {
  if (has_all(scan, kPrefixedNormal)) return &kPrefixedNormal;
  return has_all(scan, kNormal) ? &kNormal : nullptr;
}

const char* invalid_state_name(const E57Scan& scan) {
  return &position_names(scan) == &kCartesian ? "cartesianInvalidState" : "sphericalInvalidState";
}

std::string snake_case(std::string_view name) {
  const auto is_capital = [](char c) { return c >= 'A' && c <= 'Z'; };
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (is_capital(c) && i > 0 && !is_capital(name[i - 1]) && result.back() != '_') result += '_';
    if (is_capital(c)) {
      result += static_cast<char>(c - 'A' + 'a');
    } else {
      result += c == ':' || c == '.' || c == '-' ? '_' : c;
    }
  }
  return result;
}

// Returns the smallest type for `minimum` and all that can be added to it in `bits`.
Scalar integer_type(std::int64_t minimum, unsigned bits) {
  if (bits > 32 || minimum < std::numeric_limits<std::int32_t>::min() ||
      minimum > std::numeric_limits<std::uint32_t>::max())
    return Scalar::kFloat64;
  const std::int64_t maximum = minimum + static_cast<std::int64_t>((std::uint64_t{1} << bits) - 1);
  for (const Scalar type :
       {Scalar::kUint8, Scalar::kInt8, Scalar::kUint16, Scalar::kInt16, Scalar::kUint32, Scalar::kInt32}) {
    const bool fits = with_type(type, [&](auto zero) {
      using Limits = std::numeric_limits<decltype(zero)>;
      return static_cast<double>(minimum) >= static_cast<double>(Limits::lowest()) &&
             static_cast<double>(maximum) <= static_cast<double>(Limits::max());
    });
    if (fits) return type;
  }
  return Scalar::kFloat64;
}

Scalar type_of(const E57Field& field, std::int64_t added) {
  if (field.type == E57Field::Type::kFloat32) return Scalar::kFloat32;
  if (field.type != E57Field::Type::kInteger ||
      field.minimum > std::numeric_limits<std::int64_t>::max() - added)
    return Scalar::kFloat64;
  return integer_type(field.minimum + added, field.bits);
}

std::vector<FieldColumn> field_columns(const E57Scan& scan) {
  const VectorNames& position = position_names(scan);
  const VectorNames* const normal = normal_names(scan);
  std::vector<FieldColumn> columns;
  for (const E57Field& field : scan.fields) {
    const auto rank_in = [&](const VectorNames& names) {
      return static_cast<std::size_t>(std::find(names.begin(), names.end(), field.name) - names.begin());
    };
    if (const std::size_t axis = rank_in(position); axis < 3) {
      columns.push_back({.name = kPositionNames[axis], .type = Scalar::kFloat64});
    } else if (normal != nullptr && rank_in(*normal) < 3) {
      // Normals are turned, so integers would not do.
      const bool is_single = field.type == E57Field::Type::kFloat32;
      columns.push_back(
          {.name = kNormalNames[rank_in(*normal)], .type = is_single ? Scalar::kFloat32 : Scalar::kFloat64});
    } else if (field.name == "returnIndex" && field.type == E57Field::Type::kInteger) {
      columns.push_back({.name = "return_number", .type = type_of(field, 1), .added = 1});
    } else {
      const auto* const renamed = std::find_if(
          kRenamed.begin(), kRenamed.end(), [&](const Renamed& entry) { return entry.field == field.name; });
      const std::string name = renamed != kRenamed.end() ? renamed->column : snake_case(field.name);
      columns.push_back({.name = property_name(name), .type = type_of(field, 0)});
    }
  }
  return columns;
}

void check_columns(const PagedFile& pages, const E57Scan& scan, std::size_t number,
                   const std::vector<FieldColumn>& columns) {
  const auto fail = [&](const std::string& reason) {
    pages.fail_physical(scan.points_at, "scan " + std::to_string(number) + ": " + reason);
  };
  if (!has_all(scan, position_names(scan))) {
    fail(
        "its points have no position; cartesianX Y Z, or sphericalRange Azimuth Elevation are needed; "
        "--skip-damaged leaves out this scan, if others have one");
  }
  std::unordered_set<std::string_view> names = {"scan"};
  for (const FieldColumn& column : columns) {
    if (!names.insert(column.name).second) {
      fail("two fields become the column " + in_quotes(column.name) + "; names must differ");
    }
  }
}

}  // namespace

std::uint64_t drop_scans_without_position(E57Header& header) {
  const auto has_position = [](const E57Scan& scan) { return has_all(scan, position_names(scan)); };
  if (std::ranges::none_of(header.scans, has_position)) return 0;
  std::uint64_t count = 0;
  for (E57Scan& scan : header.scans) {
    if (scan.records == 0 || has_position(scan)) continue;
    scan.records = scan.points_at = 0;
    scan.fields.clear();
    ++count;
  }
  return count;
}

E57Columns e57_columns(const PagedFile& pages, const E57Header& header) {
  std::vector<std::pair<std::string, Scalar>> all;
  std::unordered_map<std::string, std::size_t> ranks;
  const auto add = [&](const std::string& name, Scalar type) {
    const auto [found, is_new] = ranks.emplace(name, all.size());
    if (is_new) {
      all.emplace_back(name, type);
    } else if (all[found->second].second != type) {
      all[found->second].second = Scalar::kFloat64;
    }
  };
  for (const char* name : kPositionNames) add(name, Scalar::kFloat64);
  for (std::size_t i = 0; i < header.scans.size(); ++i) {
    if (header.scans[i].records == 0) continue;
    const std::vector<FieldColumn> columns = field_columns(header.scans[i]);
    check_columns(pages, header.scans[i], i, columns);
    for (const FieldColumn& column : columns) add(column.name, column.type);
    if (all.size() >= kMostColumns) {  // `scan` is one more
      pages.fail_physical(header.scans[i].points_at,
                          "scan " + std::to_string(i) + ": the scans so far have " + kTooManyColumns);
    }
  }
  add("scan", Scalar::kUint32);
  return {.layout = packed_layout(all), .ranks = std::move(ranks)};
}

E57ScanColumns e57_scan_columns(const E57Scan& scan, const E57Columns& columns) {
  E57ScanColumns result{.is_spherical = &position_names(scan) == &kSpherical,
                        .has_normals = normal_names(scan) != nullptr};
  const std::string_view invalid_state = invalid_state_name(scan);
  std::vector<bool> is_given(columns.layout.properties.size());
  is_given.back() = true;  // scan
  for (const FieldColumn& column : field_columns(scan)) {
    const std::size_t property = columns.ranks.at(column.name);
    if (scan.fields[result.fields.size()].name == invalid_state) result.invalid_state = property;
    result.fields.push_back({.property = property, .added = column.added});
    is_given[property] = true;
  }
  for (std::size_t i = 0; i < is_given.size(); ++i) {
    if (!is_given[i]) result.missing.push_back(i);
  }
  return result;
}

}  // namespace lacuna::io
