// SPDX-License-Identifier: Apache-2.0
#include "io/results/points_form.hpp"

#include "io/ply/ply_writer.hpp"
#include "io/results/local_coordinates.hpp"
#include "io/rows/scalar.hpp"
#include "io/text/csv_writer.hpp"

namespace lacuna::io {
namespace {

class CsvForm final : public JoinedForm {
 public:
  using JoinedForm::JoinedForm;
  std::unique_ptr<RowsWriter> writer(OutputFile& out, std::uint64_t) const override {
    return std::make_unique<CsvWriter>(out, with_results());
  }
};

class PlyForm final : public JoinedForm {
 public:
  using JoinedForm::JoinedForm;
  std::unique_ptr<RowsWriter> writer(OutputFile& out, std::uint64_t rows) const override {
    PlyElement vertex{.name = "vertex", .count = rows, .properties = {}};
    for (const Property& property : with_results().properties)
      vertex.properties.push_back({property.name, property.type, {}});
    return std::make_unique<PlyWriter>(out, std::vector{std::move(vertex)}, offset());
  }
};

}  // namespace

JoinedForm::JoinedForm(const PointsPlan& plan, const std::vector<RowLayout>& layouts)
    : scan_(plan.scan),
      files_(plan.files),
      offset_(plan.offset),
      results_(plan.results),
      input_(join_layouts(
          std::span(layouts).subspan(files_.first, files_.end - files_.first),
          [&](const RowLayout& layout, std::size_t i) { return is_earlier_result(layout, i, results_); })) {}

std::unique_ptr<JoinedRows> JoinedForm::open_joined() const {
  return std::make_unique<JoinedRows>(scan_, input_, files_, offset_);
}

RowLayout JoinedForm::with_results() const {
  RowLayout all = input_;
  for (const ResultColumn& result : results_) {
    all.properties.push_back({.name = result.name, .type = result.type, .offset = all.stride});
    all.stride += size_of(result.type);
  }
  return all;
}

std::unique_ptr<JoinedForm> csv_form(const PointsPlan& plan) {
  return std::make_unique<CsvForm>(plan, plan.scan.layouts());
}

std::unique_ptr<JoinedForm> ply_form(const PointsPlan& plan) {
  return std::make_unique<PlyForm>(plan, written_layouts(plan.scan, plan.config));
}

}  // namespace lacuna::io
