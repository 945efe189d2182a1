// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/results/local_coordinates.hpp"
#include "io/results/points.hpp"
#include "io/results/points_pcd_rows.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

constexpr std::uint64_t kMostRows = 0xffff'ffff;  // WIDTH has 32 bits in PCL

void check_rows(const std::string& name, std::uint64_t rows) {
  if (rows > kMostRows)
    throw Error(name + ": " + std::to_string(rows) + " points, and a PCD file holds at most " +
                std::to_string(kMostRows) + "; --points-format ply or las holds more");
}

PcdInput pcd_input(const FileScan& scan, const OutputConfig& config, std::span<const ResultColumn> results,
                   const LocalOffset& offset) {
  std::optional<PcdInput> kept = kept_pcd_input(scan, results, offset);
  return kept ? std::move(*kept) : converted_pcd_input(scan, config, results, offset);
}

}  // namespace

void check_points_pcd(const FileScan& scan, const OutputConfig&) {
  check_rows("points.pcd", scan.expected_points().value_or(0));
}

std::uint64_t pcd_row_bytes(const FileScan& scan, const OutputConfig& config) {
  const std::vector<ResultColumn> results = result_columns(scan, config);
  LocalOffset any;
  if (config.local_coordinates) any = Eigen::Vector3d(0, 0, 0);
  return bytes_of(results) + pcd_input(scan, config, results, any).header.row_bytes();
}

void write_points_pcd(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out) {
  const std::vector<ResultColumn> results = result_columns(scan, config);
  const std::uint64_t rows = detection.summary.counts.points;
  check_rows(out.path().string(), rows);

  PcdInput input = pcd_input(scan, config, results, local_offset(detection, config));
  PcdHeader& header = input.header;
  if (header.width * header.height != rows) {
    header.width = rows;
    header.height = 1;
  }
  header.rows = rows;
  header.encoding = PcdEncoding::kBinary;
  const std::size_t input_bytes = header.row_bytes();
  for (const ResultColumn& result : results)
    header.fields.push_back(pcd_field_of(pcd_name_of(result.name), result.type));
  out.write(print_pcd_header(header));
  for_each_annotated_block(detection, *input.rows, input_bytes, results, out.path().string(),
                           [&](const auto& block, std::size_t) { out.write(block); });
}

}  // namespace lacuna::io
