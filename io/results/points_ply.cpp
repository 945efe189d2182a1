// SPDX-License-Identifier: Apache-2.0
#include "io/ply/ply_writer.hpp"
#include "io/results/annotated_rows.hpp"
#include "io/results/local_coordinates.hpp"
#include "io/results/points.hpp"
#include "io/results/points_form.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

bool has_own_quality(const RowLayout& layout) {
  for (std::size_t i = 0; i < layout.properties.size(); ++i) {
    if (layout.properties[i].name == kQuality && !is_earlier_quality(layout, i)) return true;
  }
  return false;
}

// The results of a run, with the quality of MeshLab unless the input has its own.
std::vector<ResultColumn> ply_results(const FileScan& scan, const OutputConfig& config) {
  std::vector<ResultColumn> results = result_columns(scan, config);
  const std::vector<RowLayout>& layouts = scan.layouts();
  if (std::any_of(layouts.begin(), layouts.end(), has_own_quality)) return results;
  const auto loop = std::find_if(results.begin(), results.end(),
                                 [](const auto& result) { return result.name == kBeforeQuality; });
  results.insert(loop + 1, {std::string(kQuality), Scalar::kFloat32, results.front().offset});
  return results;
}

class PlyRows final : public PointsWriter {
 public:
  PlyRows(OutputFile& out, PlyElement vertex, const LocalOffset& offset)
      : writer_(out, {std::move(vertex)}, offset) {}
  void put(std::span<const std::byte> rows) override { writer_.put_bytes(rows); }
  void finish() override { writer_.finish(); }

 private:
  PlyWriter writer_;
};

class PlyForm final : public PointsForm {
 public:
  explicit PlyForm(const PointsPlan& plan) : scan_(plan.scan), offset_(plan.offset) {
    input_ = join_layouts(
        written_layouts(plan.scan, plan.config),
        [&](const RowLayout& layout, std::size_t i) { return is_earlier_result(layout, i, plan.results); });
    for (const Property& property : input_.properties)
      vertex_.properties.push_back({property.name, property.type, {}});
    for (const ResultColumn& result : plan.results)
      vertex_.properties.push_back({result.name, result.type, {}});
  }

  std::size_t row_bytes() const override { return input_.stride; }
  std::unique_ptr<InputRows> open() const override { return joined_rows(scan_, input_, offset_); }
  std::unique_ptr<PointsWriter> writer(OutputFile& out, std::uint64_t rows, PointsPart) const override {
    PlyElement vertex = vertex_;
    vertex.count = rows;
    return std::make_unique<PlyRows>(out, std::move(vertex), offset_);
  }

 private:
  const FileScan& scan_;
  LocalOffset offset_;
  RowLayout input_;
  PlyElement vertex_{.name = "vertex", .count = 0, .properties = {}};
};

}  // namespace

std::unique_ptr<PointsForm> ply_form(const PointsPlan& plan) {
  return std::make_unique<PlyForm>(plan);
}

std::uint64_t ply_row_bytes(const FileScan& scan, const OutputConfig& config) {
  const PointsPlan plan{.scan = scan, .config = config, .results = ply_results(scan, config)};
  return PlyForm(plan).row_bytes() + bytes_of(plan.results);
}

void write_points_ply(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out) {
  const PointsPlan plan{.scan = scan,
                        .config = config,
                        .results = ply_results(scan, config),
                        .offset = local_offset(detection, config)};
  write_annotated(detection, PlyForm(plan), plan.results, out);
}

}  // namespace lacuna::io
