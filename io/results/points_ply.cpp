// SPDX-License-Identifier: Apache-2.0
#include "io/ply/ply_writer.hpp"
#include "io/results/local_coordinates.hpp"
#include "io/results/points_form.hpp"

#include <memory>
#include <utility>

namespace lacuna::io {
namespace {

class PlyRows final : public PointsWriter {
 public:
  PlyRows(OutputFile& out, PlyElement vertex, const LocalOffset& offset)
      : writer_(out, {std::move(vertex)}, offset) {}
  void put(std::span<const std::byte> rows) override { writer_.put_bytes(rows); }
  void finish() override { writer_.finish(); }

 private:
  PlyWriter writer_;
};

class PlyForm final : public JoinedForm {
 public:
  using JoinedForm::JoinedForm;
  std::unique_ptr<PointsWriter> writer(OutputFile& out, std::uint64_t rows) const override {
    PlyElement vertex{.name = "vertex", .count = rows, .properties = {}};
    for (const Property& property : with_results().properties)
      vertex.properties.push_back({property.name, property.type, {}});
    return std::make_unique<PlyRows>(out, std::move(vertex), offset());
  }
};

}  // namespace

std::unique_ptr<JoinedForm> ply_form(const PointsPlan& plan) {
  return std::make_unique<PlyForm>(plan, written_layouts(plan.scan, plan.config));
}

}  // namespace lacuna::io
