// SPDX-License-Identifier: Apache-2.0
#include "io/scan/scan_arrays.hpp"

#include <algorithm>
#include <cstring>

namespace lacuna::io {
namespace {

template <std::size_t size>
void copy_column(const std::byte* from, std::ptrdiff_t from_stride, std::byte* to, std::size_t to_stride,
                 std::size_t count) {
  for (std::size_t i = 0; i < count; ++i, from += from_stride, to += to_stride) std::memcpy(to, from, size);
}

class ArrayReader final : public ScanReader {
 public:
  explicit ArrayReader(const ScanArrays& arrays) : arrays_(arrays) {
    for (const ScanColumn& column : arrays.columns) {
      layout_.properties.push_back({column.name, column.type, layout_.stride});
      layout_.stride += size_of(column.type);
    }
  }

  std::string format() const override { return "arrays"; }
  const RowLayout& layout() const override { return layout_; }
  std::optional<std::uint64_t> expected_rows() const override { return arrays_.rows; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    batch.count = std::min<std::uint64_t>(max_rows, arrays_.rows - next_);
    batch.bytes.resize(batch.count * layout_.stride);
    for (std::size_t i = 0; i < arrays_.columns.size(); ++i) copy(i, batch);
    next_ += batch.count;
    return batch.count > 0;
  }

 private:
  void copy(std::size_t i, RowBatch& batch) const {
    const auto& [name, type, first, stride] = arrays_.columns[i];
    const std::byte* const from = first + static_cast<std::ptrdiff_t>(next_) * stride;
    std::byte* const to = batch.bytes.data() + layout_.properties[i].offset;
    switch (size_of(type)) {
      case 1:
        return copy_column<1>(from, stride, to, layout_.stride, batch.count);
      case 2:
        return copy_column<2>(from, stride, to, layout_.stride, batch.count);
      case 4:
        return copy_column<4>(from, stride, to, layout_.stride, batch.count);
      default:
        return copy_column<8>(from, stride, to, layout_.stride, batch.count);
    }
  }

  const ScanArrays& arrays_;
  RowLayout layout_;
  std::uint64_t next_ = 0;
};

}  // namespace

std::unique_ptr<ScanReader> read_arrays(const ScanArrays& arrays) {
  return std::make_unique<ArrayReader>(arrays);
}

}  // namespace lacuna::io
