// SPDX-License-Identifier: Apache-2.0
#include "io/rows/offset_reader.hpp"

#include "io/rows/scalar.hpp"
#include "io/rows/vectors.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

class OffsetReader final : public ScanReader {
 public:
  OffsetReader(std::unique_ptr<ScanReader> reader, const Eigen::Vector3d& offset)
      : reader_(std::move(reader)),
        layout_(with_components_as(Scalar::kFloat64, kPositionNames, reader_->layout())) {
    for (const Property& column : layout_.properties) summands_.push_back(component_of(offset, column.name));
  }

  std::string format() const override { return reader_->format(); }
  const RowLayout& layout() const override { return layout_; }
  std::optional<std::uint64_t> expected_rows() const override { return reader_->expected_rows(); }
  bool is_slow() const override { return reader_->is_slow(); }
  std::vector<ScannerPose> scanners() const override { return reader_->scanners(); }
  std::vector<Eigen::Vector3d> no_return_places() const override { return reader_->no_return_places(); }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    if (!reader_->next(rows_, max_rows)) return false;
    batch.count = rows_.count;
    batch.bytes.resize(rows_.count * layout_.stride);
    for (std::size_t i = 0; i < layout_.properties.size(); ++i) {
      const Property &from = reader_->layout().properties[i], &to = layout_.properties[i];
      const ConstColumn source{
          .data = rows_.bytes.data() + from.offset, .stride = reader_->layout().stride, .type = from.type};
      const Column target{.data = batch.bytes.data() + to.offset, .stride = layout_.stride, .type = to.type};
      copy_column(source, summands_[i], target, rows_.count);
    }
    return true;
  }

 private:
  std::unique_ptr<ScanReader> reader_;
  RowLayout layout_;
  std::vector<std::optional<double>> summands_;  // of each column; empty if it stays as it is
  RowBatch rows_;                                // as the reader gives them
};

}  // namespace

std::unique_ptr<ScanReader> with_offset(std::unique_ptr<ScanReader> reader, const LocalOffset& offset) {
  if (!offset) return reader;
  return std::make_unique<OffsetReader>(std::move(reader), *offset);
}

}  // namespace lacuna::io
