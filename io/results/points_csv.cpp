// SPDX-License-Identifier: Apache-2.0
#include "io/results/annotated_rows.hpp"
#include "io/results/points.hpp"
#include "io/results/points_form.hpp"
#include "io/scalar.hpp"
#include "io/text/csv_writer.hpp"

#include <utility>

namespace lacuna::io {
namespace {

RowLayout input_layout(const FileScan& scan, std::span<const ResultColumn> results) {
  return join_layouts(scan.layouts(), [&](const RowLayout& layout, std::size_t i) {
    return is_earlier_result(layout, i, results);
  });
}

class CsvRows final : public PointsWriter {
 public:
  CsvRows(OutputFile& out, RowLayout layout) : writer_(out, std::move(layout)) {}
  void put(std::span<const std::byte> rows) override { writer_.put_rows(rows); }

 private:
  CsvWriter writer_;
};

class CsvForm final : public PointsForm {
 public:
  explicit CsvForm(const PointsPlan& plan)
      : scan_(plan.scan), input_(input_layout(plan.scan, plan.results)), all_(input_) {
    for (const ResultColumn& result : plan.results) {
      all_.properties.push_back({.name = result.name, .type = result.type, .offset = all_.stride});
      all_.stride += size_of(result.type);
    }
  }

  std::size_t row_bytes() const override { return input_.stride; }
  std::unique_ptr<InputRows> open() const override { return joined_rows(scan_, input_); }
  std::unique_ptr<PointsWriter> writer(OutputFile& out, std::uint64_t, PointsPart) const override {
    return std::make_unique<CsvRows>(out, all_);
  }

 private:
  const FileScan& scan_;
  RowLayout input_, all_;
};

}  // namespace

FileMark points_csv_mark() {
  return {",scalar_boundary,scalar_coherent,scalar_loop", FileMark::kInFirstLine};
}

std::uint64_t csv_row_bytes(const FileScan& scan, const OutputConfig& config) {
  const std::vector<ResultColumn> results = result_columns(scan, config);
  std::uint64_t bytes = 0;
  const auto add = [&](Scalar type) { bytes += is_integer(type) ? 3 : size_of(type) + 4; };
  for (const Property& property : input_layout(scan, results).properties) add(property.type);
  for (const ResultColumn& result : results) add(result.type);
  return bytes;
}

std::unique_ptr<PointsForm> csv_form(const PointsPlan& plan) {
  return std::make_unique<CsvForm>(plan);
}

void write_points_csv(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out) {
  const PointsPlan plan{.scan = scan, .config = config, .results = result_columns(scan, config)};
  write_annotated(detection, CsvForm(plan), plan.results, out);
}

}  // namespace lacuna::io
