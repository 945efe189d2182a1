// SPDX-License-Identifier: Apache-2.0
#include "io/read/e57/e57.hpp"
#include "io/read/files/number.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cassert>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace lacuna::io {
namespace {

// The columns of rows that the fields of E57 scans become.
//
//   cartesianX Y Z, or without them sphericalRange Azimuth Elevation   x y z, doubles
//   colorRed Green Blue                                                red green blue
//   normalX Y Z, also with the prefix nor:, if all three are there     nx ny nz
//   returnIndex                                     return_number: one more, since LAS counts from 1
//   returnCount                                                        number_of_returns
//   any other                        its name in snake case: rowIndex row_index, ext:someValue ext_some_value
//
// Floats keep their precision. An integer has the smallest type for all values of its bits: a colour up to
// 255 is a byte. Integers of more than 32 bits and scaled integers are doubles. The last column is `scan`, a
// uint32: the rank of the scan in the file. Scans of one file may have different fields. The file has the
// columns of all its scans, by name, in the order in which they first appear. A column with several types
// becomes doubles.

struct E57Columns {
  RowLayout layout;
  std::unordered_map<std::string, std::size_t> ranks;  // of properties, by name
};

// The mapping of one scan's fields to the columns of its file.
struct E57ScanColumns {
  struct Target {
    std::size_t property;  // its rank
    std::int64_t added;    // to an integer
  };
  std::vector<Target> fields;        // of each field
  std::vector<std::size_t> missing;  // ranks of properties that the scan does not have
  bool is_spherical = false;         // x y z are given as range, azimuth and elevation
  bool has_normals = false;
  std::optional<std::size_t> invalid_state;  // the property that says which positions are none
};

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
    fail("its points have no position; cartesianX Y Z, or sphericalRange Azimuth Elevation are needed");
  }
  std::unordered_set<std::string_view> names = {"scan"};
  for (const FieldColumn& column : columns) {
    if (!names.insert(column.name).second) {
      fail("two fields become the column " + in_quotes(column.name) + "; names must differ");
    }
  }
}

// Throws `Error` unless each scan with points has a position, and the names of its columns differ.
// Cost: linear in the fields of all scans.
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

// Cost: linear in the columns of the file.
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

constexpr std::size_t kDecodedBytes = std::size_t{8} << 20;
constexpr std::size_t kMostRows = std::size_t{1} << 16;
constexpr std::size_t kTogether = 512;  // rows that stay in the cache while field after field is filled

class E57Reader final : public ScanReader {
 public:
  E57Reader(const std::filesystem::path& file, const ReadOptions& options)
      : trusts_header_(options.trust == Trust::kHeader),
        header_(read_e57_header(file)),
        pages_(file, header_.page_bytes),
        columns_(e57_columns(pages_, header_)) {}

  std::string format() const override {
    const std::size_t scans = header_.scans.size();
    return "E57 1.0, " + std::to_string(scans) + (scans == 1 ? " scan" : " scans");
  }
  const RowLayout& layout() const override { return columns_.layout; }
  std::optional<std::uint64_t> expected_rows() const override {
    std::uint64_t rows = 0;
    for (const E57Scan& scan : header_.scans) rows += scan.records;
    return rows;
  }

  std::string crs() const override { return header_.coordinate_metadata; }
  std::string length_unit() const override { return "m"; }  // ASTM E2807, 6.4.1

  std::vector<ScannerPose> scanners() const override {
    std::vector<ScannerPose> scanners;
    for (std::size_t i = 0; i < header_.scans.size(); ++i) {
      const E57Scan& scan = header_.scans[i];
      if (!scan.has_pose) continue;
      scanners.push_back({.place = scan.pose.translation(),
                          .axis = scan.pose.linear().col(2),
                          .source = static_cast<std::uint32_t>(i)});
    }
    return scanners;
  }

  std::vector<ReaderNote> notes() const override {
    const auto count = std::ranges::count_if(header_.scans, &E57Scan::has_zero_rotation);
    return {{.count = static_cast<std::uint64_t>(count),
             .thing = "scan",
             .what =
                 " with the quaternion 0 0 0 0, taken for no rotation; a pose in a list of files can turn "
                 "the file"}};
  }
  RowFindings findings() const override { return findings_; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    assert(max_rows > 0);
    const std::size_t stride = columns_.layout.stride;
    const std::size_t rows =
        std::min({max_rows, kMostRows, std::max<std::size_t>(1, kDecodedBytes / stride)});
    batch.bytes.resize(rows * stride);
    batch.count = 0;
    while (batch.count < rows && begin_scan()) {
      const std::size_t count = points_->ready(std::min(rows - batch.count, kTogether));
      put({.data = batch.bytes.data() + batch.count * stride, .stride = stride, .count = count});
      points_->pass(count);
      if (points_->left() == 0 && !trusts_header_) points_->require_end();
      batch.count += count;
    }
    batch.bytes.resize(batch.count * stride);
    return batch.count > 0;
  }

 private:
  // Moves to a scan with points left; false at the end.
  bool begin_scan() {
    while (!points_ || points_->left() == 0) {
      if (next_scan_ == header_.scans.size()) return false;
      const E57Scan& scan = header_.scans[next_scan_++];
      if (scan.records == 0 && (scan.points_at == 0 || trusts_header_)) continue;
      points_.emplace(pages_, scan, next_scan_ - 1);
      if (scan.records == 0) {
        points_->require_end();
        continue;
      }
      scan_columns_ = e57_scan_columns(scan, columns_);
    }
    return true;
  }

  void put(E57Rows rows) {
    const auto column = [&](std::size_t rank) {
      const Property& property = columns_.layout.properties[rank];
      return Column{.data = rows.data + property.offset, .stride = rows.stride, .type = property.type};
    };
    for (std::size_t i = 0; i < scan_columns_.fields.size(); ++i) {
      const auto& [property, added] = scan_columns_.fields[i];
      points_->take(i, rows.count, column(property), added);
    }
    for (const std::size_t property : scan_columns_.missing) fill_missing(column(property), rows.count);
    if (scan_columns_.invalid_state) drop_invalid(rows, column(*scan_columns_.invalid_state));
    const Pose& pose = header_.scans[next_scan_ - 1].pose;
    if (scan_columns_.is_spherical) findings_.wide_angles += spherical_to_cartesian(rows);
    place_points(rows, pose);
    if (scan_columns_.has_normals) {
      const auto rank = [&](const char* name) { return columns_.ranks.at(name); };
      turn_normals({column(rank("nx")), column(rank("ny")), column(rank("nz"))}, rows.count, pose);
    }
    const Column scan = column(columns_.layout.properties.size() - 1);
    for (std::size_t i = 0; i < rows.count; ++i) {
      store(scan.data + i * scan.stride, static_cast<std::uint32_t>(next_scan_ - 1));
    }
  }

  bool trusts_header_;
  E57Header header_;
  PagedFile pages_;
  E57Columns columns_;
  std::size_t next_scan_ = 0;
  std::optional<E57Points> points_;  // of the scan before the next one
  E57ScanColumns scan_columns_;
  RowFindings findings_;
};

}  // namespace

bool looks_like_e57(const FileStart& start) {
  return start.first_bytes.starts_with("ASTM-E57");
}

std::unique_ptr<ScanReader> open_e57(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<E57Reader>(file, options);
}

}  // namespace lacuna::io
