// SPDX-License-Identifier: Apache-2.0
#include "io/results/points_form.hpp"
#include "io/text/csv_writer.hpp"

#include <utility>

namespace lacuna::io {
namespace {

class CsvRows final : public PointsWriter {
 public:
  CsvRows(OutputFile& out, RowLayout layout) : writer_(out, std::move(layout)) {}
  void put(std::span<const std::byte> rows) override { writer_.put_rows(rows); }

 private:
  CsvWriter writer_;
};

class CsvForm final : public JoinedForm {
 public:
  using JoinedForm::JoinedForm;
  std::unique_ptr<PointsWriter> writer(OutputFile& out, std::uint64_t) const override {
    return std::make_unique<CsvRows>(out, with_results());
  }
};

}  // namespace

std::unique_ptr<JoinedForm> csv_form(const PointsPlan& plan) {
  return std::make_unique<CsvForm>(plan, plan.scan.layouts());
}

}  // namespace lacuna::io
