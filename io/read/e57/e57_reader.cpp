// SPDX-License-Identifier: Apache-2.0
#include "io/read/e57/e57_reader.hpp"

#include "io/read/e57/e57_columns.hpp"
#include "io/read/e57/e57_header.hpp"
#include "io/read/e57/e57_place.hpp"
#include "io/read/e57/e57_points.hpp"
#include "io/read/files/little_endian.hpp"
#include "io/read/rows/scalar.hpp"

#include <algorithm>
#include <cassert>
#include <optional>

namespace lacuna::io {
namespace {

constexpr std::size_t kDecodedBytes = std::size_t{8} << 20;
constexpr std::size_t kMostRows = std::size_t{1} << 16;
constexpr std::size_t kTogether = 512;  // rows that stay in the cache while field after field is filled

class E57Reader final : public ScanReader {
 public:
  E57Reader(const std::filesystem::path& file, const ReadOptions& options)
      : trusts_header_(options.trust == Trust::kHeader),
        header_(read_e57_header(file)),
        pages_(file, header_.page_bytes),
        without_position_(options.skip_damaged ? drop_scans_without_position(header_) : 0),
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
    return {
        {.count = static_cast<std::uint64_t>(count),
         .thing = "scan",
         .what = " with the quaternion 0 0 0 0, taken for no rotation; a pose in a list of files can turn "
                 "the file"},
        {.count = without_position_,
         .thing = "scan",
         .what = " whose points have no position; left out, as --skip-damaged says"}};
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
  std::uint64_t without_position_;  // scans that are left out
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
