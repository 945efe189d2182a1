// SPDX-License-Identifier: Apache-2.0
#include "io/results/points.hpp"

#include "io/results/points_form.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

namespace lacuna::io {
namespace {

PointsFormat format_like(const std::string& name) {
  const auto is = [&](std::string_view family) { return name.starts_with(family); };
  if (is("LAS")) return PointsFormat::kLas;
  if (is("LAZ")) return PointsFormat::kLaz;
  if (is("PCD")) return PointsFormat::kPcd;
  if (is("text")) return PointsFormat::kCsv;
  return PointsFormat::kPly;
}

}  // namespace

PointsFormat points_format(const FileScan& scan, const OutputConfig& config) {
  if (config.points_format != PointsFormat::kInput) return config.points_format;
  const auto& formats = scan.formats();
  if (formats.empty()) return PointsFormat::kPly;
  const auto are_all = [&](auto... allowed) {
    return std::all_of(formats.begin(), formats.end(),
                       [&](const auto& name) { return ((format_like(name) == allowed) || ...); });
  };
  const PointsFormat first = format_like(formats.front());
  if (are_all(first)) return first;
  return are_all(PointsFormat::kLas, PointsFormat::kLaz) ? PointsFormat::kLas : PointsFormat::kPly;
}

std::string extension_of(PointsFormat format) {
  switch (format) {
    case PointsFormat::kLas:
      return ".las";
    case PointsFormat::kLaz:
      return ".laz";
    case PointsFormat::kPcd:
      return ".pcd";
    case PointsFormat::kCsv:
      return ".csv";
    default:
      return ".ply";
  }
}

std::string points_file(const FileScan& scan, const OutputConfig& config) {
  return "points" + extension_of(points_format(scan, config));
}

void write_annotated(const Detection& detection, const PointsForm& form,
                     std::span<const ResultColumn> results, OutputFile& out) {
  const std::unique_ptr<InputRows> rows = form.open();
  const std::size_t stride = form.row_bytes() + bytes_of(results);
  const auto writer = form.writer(out, detection.summary.counts.points, PointsPart::kAll);
  const auto put = [&](std::vector<std::byte>& block, std::size_t count) {
    std::size_t kept = 0;
    auto left_out = rows->left_out();
    if (left_out.empty()) return writer->put(block);
    for (std::size_t row = 0; row < count; ++row) {
      if (!left_out.empty() && left_out.front() == row) {
        left_out = left_out.subspan(1);
      } else {
        std::memmove(&block[kept++ * stride], &block[row * stride], stride);
      }
    }
    writer->put(std::span(block).first(kept * stride));
  };
  for_each_annotated_block(detection, *rows, form.row_bytes(), results, out.path().string(), put);
  writer->finish();
}

void check_points(const FileScan& scan, const OutputConfig& config) {
  const PointsFormat format = points_format(scan, config);
  if (format == PointsFormat::kLas) check_points_las(scan, config);
  if (format == PointsFormat::kLaz) check_points_laz(scan, config);
  if (format == PointsFormat::kPcd) check_points_pcd(scan, config);
}

std::uint64_t point_row_bytes(const FileScan& scan, const OutputConfig& config) {
  switch (points_format(scan, config)) {
    case PointsFormat::kLas:
      return las_row_bytes(scan, config);
    case PointsFormat::kLaz:
      return laz_row_bytes(scan, config);
    case PointsFormat::kPcd:
      return pcd_row_bytes(scan, config);
    case PointsFormat::kCsv:
      return csv_row_bytes(scan, config);
    default:
      return ply_row_bytes(scan, config);
  }
}

}  // namespace lacuna::io
