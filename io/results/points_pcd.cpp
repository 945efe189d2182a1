// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/results/local_coordinates.hpp"
#include "io/results/points.hpp"
#include "io/results/points_form.hpp"
#include "io/results/points_pcd_rows.hpp"

#include <memory>
#include <optional>
#include <span>
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

PcdInput pcd_input(const PointsPlan& plan) {
  std::optional<PcdInput> kept = kept_pcd_input(plan.scan, plan.results, plan.offset);
  return kept ? std::move(*kept) : converted_pcd_input(plan.scan, plan.config, plan.results, plan.offset);
}

class PcdWriter final : public PointsWriter {
 public:
  PcdWriter(OutputFile& out, const PcdHeader& header) : out_(out) { out_.write(print_pcd_header(header)); }
  void put(std::span<const std::byte> rows) override { out_.write(rows); }

 private:
  OutputFile& out_;
};

class PcdForm final : public PointsForm {
 public:
  explicit PcdForm(PointsPlan plan) : plan_(std::move(plan)), header_(pcd_input(plan_).header) {
    row_bytes_ = header_.row_bytes();
    header_.encoding = PcdEncoding::kBinary;
    for (const ResultColumn& result : plan_.results)
      header_.fields.push_back(pcd_field_of(pcd_name_of(result.name), result.type));
  }

  std::size_t row_bytes() const override { return row_bytes_; }
  std::unique_ptr<InputRows> open() const override { return pcd_input(plan_).rows; }
  std::unique_ptr<PointsWriter> writer(OutputFile& out, std::uint64_t rows, PointsPart) const override {
    check_rows(out.path().string(), rows);
    PcdHeader header = header_;
    if (header.width * header.height != rows) {
      header.width = rows;
      header.height = 1;
    }
    header.rows = rows;
    return std::make_unique<PcdWriter>(out, header);
  }

 private:
  PointsPlan plan_;
  PcdHeader header_;
  std::size_t row_bytes_ = 0;
};

}  // namespace

std::unique_ptr<PointsForm> pcd_form(const PointsPlan& plan) {
  return std::make_unique<PcdForm>(plan);
}

void check_points_pcd(const FileScan& scan, const OutputConfig&) {
  check_rows("points.pcd", scan.expected_points().value_or(0));
}

std::uint64_t pcd_row_bytes(const FileScan& scan, const OutputConfig& config) {
  LocalOffset any;
  if (config.local_coordinates) any = Eigen::Vector3d(0, 0, 0);
  const PointsPlan plan{
      .scan = scan, .config = config, .results = result_columns(scan, config), .offset = any};
  return PcdForm(plan).row_bytes() + bytes_of(plan.results);
}

void write_points_pcd(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out) {
  const PointsPlan plan{.scan = scan,
                        .config = config,
                        .results = result_columns(scan, config),
                        .offset = local_offset(detection, config)};
  write_annotated(detection, PcdForm(plan), plan.results, out);
}

}  // namespace lacuna::io
