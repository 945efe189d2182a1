#include "io/offset_reader.hpp"

#include "io/scalar.hpp"
#include "io/vectors.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

class OffsetReader final : public ScanReader {
 public:
  OffsetReader(std::unique_ptr<ScanReader> reader, const Eigen::Vector3d& offset)
      : reader_(std::move(reader)) {
    std::vector<std::pair<std::string, Scalar>> columns;
    for (const Property& property : reader_->layout().properties) {
      const auto axis = std::find(kPositionNames.begin(), kPositionNames.end(), property.name);
      const bool is_position = axis != kPositionNames.end();
      columns.emplace_back(property.name, is_position ? Scalar::kFloat64 : property.type);
      summands_.push_back(is_position ? std::optional(offset[axis - kPositionNames.begin()]) : std::nullopt);
    }
    layout_ = packed_layout(columns);
  }

  std::string format() const override { return reader_->format(); }
  const RowLayout& layout() const override { return layout_; }
  std::optional<std::uint64_t> expected_rows() const override { return reader_->expected_rows(); }
  bool is_slow() const override { return reader_->is_slow(); }
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
      if (summands_[i]) {
        copy_sums(source, *summands_[i], target, rows_.count);
      } else {
        copy_column(source, target, rows_.count);
      }
    }
    return true;
  }

 private:
  std::unique_ptr<ScanReader> reader_;
  std::vector<std::optional<double>> summands_;  // one for each column; none: it stays as it is
  RowLayout layout_;
  RowBatch rows_;  // as the reader gives them
};

}  // namespace

std::unique_ptr<ScanReader> with_offset(std::unique_ptr<ScanReader> reader, const LocalOffset& offset) {
  if (!offset) return reader;
  return std::make_unique<OffsetReader>(std::move(reader), *offset);
}

}  // namespace lacuna::io
