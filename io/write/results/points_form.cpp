// SPDX-License-Identifier: Apache-2.0
#include "io/write/results/points_form.hpp"

#include "io/read/ply/ply_writer.hpp"
#include "io/read/text/csv_writer.hpp"
#include "io/write/results/local_coordinates.hpp"

namespace lacuna::io {
namespace {

// Rows of files of any formats, joined by the names of columns.
class JoinedForm : public PointsForm {
 public:
  JoinedForm(const PointsPlan& plan, const std::vector<RowLayout>& layouts)
      : scan_(plan.scan),
        files_(plan.files),
        offset_(plan.offset),
        results_(plan.results),
        input_(join_layouts(
            std::span(layouts).subspan(files_.first, files_.last - files_.first),
            [&](const RowLayout& layout, std::size_t i) { return is_earlier_result(layout, i, results_); })) {
  }
  std::size_t row_bytes() const final { return input_.stride; }
  std::unique_ptr<InputRows> open() const final {
    return std::make_unique<JoinedRows>(scan_, input_, files_, offset_);
  }

 protected:
  // The columns of the rows, then the columns of the results.
  RowLayout with_results() const {
    RowLayout all = input_;
    for (const ResultColumn& result : results_) {
      all.properties.push_back({.name = result.name, .type = result.type, .offset = all.stride});
      all.stride += size_of(result.type);
    }
    return all;
  }
  const LocalOffset& offset() const { return offset_; }

 private:
  const ScanFiles& scan_;
  IndexRange files_;
  LocalOffset offset_;
  std::vector<ResultColumn> results_;
  RowLayout input_;
};

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

std::unique_ptr<PointsForm> csv_form(const PointsPlan& plan) {
  return std::make_unique<CsvForm>(plan, layouts_of(plan.scan));
}

std::unique_ptr<PointsForm> ply_form(const PointsPlan& plan) {
  return std::make_unique<PlyForm>(plan, written_layouts(plan.scan, plan.config));
}

}  // namespace lacuna::io
