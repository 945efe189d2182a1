// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_reader.hpp"

#include "engine/run/parallel.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/las/las_columns.hpp"
#include "io/read/las/las_header.hpp"
#include "io/read/las/las_points.hpp"

#include <algorithm>
#include <cassert>
#include <span>
#include <string>
#include <vector>

namespace lacuna::io {
namespace {

// Returns the bytes of points and of nothing else: up to the records behind them.
std::uint64_t point_bytes(const InputFile& in, const LasHeader& header) {
  std::uint64_t end = in.position() + in.remaining();
  for (const LasRecordExtent& record : header.extended) {
    if (record.at >= header.points_at) end = std::min(end, record.at);
  }
  return end - header.points_at;
}

// Returns the header with the number of points that holds. Throws `Error` where the file has others and
// nobody says which number to trust.
LasHeader counted_header(InputFile& in, Trust trust) {
  LasHeader header = read_las_header(in);
  const std::uint64_t bytes = point_bytes(in, header);
  const auto fail = [&](const std::string& found) {
    in.fail_at_byte(107, "the header counts " + std::to_string(header.points) + " points, but " + found);
  };
  if (header.is_compressed) {
    constexpr std::uint64_t kTablePlace = 8;
    if (header.points == 0 && bytes > kTablePlace && trust != Trust::kHeader)
      fail(
          "compressed points follow; --trust header reads none, and `laszip` or `lasinfo -repair` count "
          "them");
    return header;
  }
  const std::uint64_t records = bytes / header.record_bytes;
  if (records == header.points || trust == Trust::kHeader) return header;
  if (trust == Trust::kNeither)
    fail(std::to_string(records) + " whole ones of " + std::to_string(header.record_bytes) +
         " bytes follow; --trust file reads these" +
         (records > header.points ? ", --trust header the others" : ""));
  header.points = records;
  return header;
}

class LasReader final : public ScanReader {
 public:
  LasReader(const std::filesystem::path& file, const ReadOptions& options)
      : in_(file),
        header_(counted_header(in_, options.trust)),
        points_(las_points(in_, header_, options.trust, options.memory)),
        columns_(header_),
        left_(header_.points) {}

  std::string format() const override {
    return (header_.is_compressed ? "LAZ 1." : "LAS 1.") + std::to_string(header_.minor) + ", point format " +
           std::to_string(header_.point_format);
  }
  const RowLayout& layout() const override { return columns_.layout(); }
  std::optional<std::uint64_t> expected_rows() const override { return header_.points; }
  bool is_slow() const override { return header_.is_compressed; }
  bool has_noise_classes() const override { return true; }
  std::string crs() const override { return header_.crs.text(); }
  std::string other_crs() const override { return header_.crs.other_text(); }
  std::vector<ReaderNote> notes() const override {
    return {{.count = header_.extra_records,
             .thing = "record",
             .what = " of extra bytes, which are together longer than those of a point; the last one holds "
                     "alone, and its values may be others"}};
  }
  bool is_geographic() const override { return header_.crs.is_geographic(); }
  std::string length_unit() const override { return header_.crs.length_unit(); }
  std::string other_unit() const override { return header_.crs.other_unit(); }
  std::string vertical_unit() const override { return header_.crs.vertical_unit(); }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    assert(max_rows > 0);
    const std::size_t fitting = kBatchBytes / std::max<std::size_t>(layout().stride, header_.record_bytes);
    batch.count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, std::min(max_rows, fitting)));
    batch.bytes.resize(batch.count * layout().stride);
    if (batch.count == 0) return false;
    records_.resize(batch.count * header_.record_bytes);
    points_->read(records_);
    unpack(batch);
    left_ -= batch.count;
    return true;
  }

 private:
  void unpack(RowBatch& batch) const {
    constexpr std::size_t kTogether = 4096;  // rows
    for_each_here((batch.count + kTogether - 1) / kTogether, [&](std::size_t i) {
      const std::size_t first = i * kTogether, count = std::min(kTogether, batch.count - first);
      columns_.unpack(std::span(records_).subspan(first * header_.record_bytes, count * header_.record_bytes),
                      batch.bytes.data() + first * layout().stride);
    });
  }

  InputFile in_;
  LasHeader header_;
  std::unique_ptr<LasPoints> points_;
  LasColumns columns_;
  std::uint64_t left_;  // points not yet read
  std::vector<std::byte> records_;
};

}  // namespace

bool looks_like_las(const FileStart& start) {
  return start.first_bytes.starts_with("LASF");
}

std::unique_ptr<ScanReader> open_las(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<LasReader>(file, options);
}

}  // namespace lacuna::io
