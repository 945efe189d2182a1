// SPDX-License-Identifier: Apache-2.0
#include "io/results/points_form.hpp"

#include "io/rows/scalar.hpp"

namespace lacuna::io {

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

}  // namespace lacuna::io
