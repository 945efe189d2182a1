// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/scan_arrays.hpp"

#include "io/read/rows/columns.hpp"

#include <algorithm>

namespace lacuna::io {
namespace {

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
    for (std::size_t i = 0; i < arrays_.columns.size(); ++i) {
      const auto& [name, type, first, stride] = arrays_.columns[i];
      copy_column({first + static_cast<std::ptrdiff_t>(next_) * stride, stride, type},
                  column_of(batch, layout_.stride, layout_.properties[i]), batch.count);
    }
    next_ += batch.count;
    return batch.count > 0;
  }

 private:
  const ScanArrays& arrays_;
  RowLayout layout_;
  std::uint64_t next_ = 0;
};

}  // namespace

std::unique_ptr<ScanReader> read_arrays(const ScanArrays& arrays) {
  return std::make_unique<ArrayReader>(arrays);
}

}  // namespace lacuna::io
