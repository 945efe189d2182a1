// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_points_writer.hpp"

#include "engine/run/parallel.hpp"
#include "io/read/files/little_endian.hpp"
#include "io/read/laz/laz_encoder.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

class PlainPointsWriter final : public LasPointsWriter {
 public:
  explicit PlainPointsWriter(OutputFile& out) : out_(out) {}

  void put(std::span<const std::byte> records) override {
    out_.write(records);
    bytes_ += records.size();
  }
  std::uint64_t finish() override { return bytes_; }

 private:
  OutputFile& out_;
  std::uint64_t bytes_ = 0;
};

// Collects a chunk for each thread, and encodes these together.
class CompressedPointsWriter final : public LasPointsWriter {
 public:
  CompressedPointsWriter(OutputFile& out, std::uint64_t points_at, LasCompression compression)
      : out_(out),
        points_at_(points_at),
        layout_(std::move(compression.layout)),
        chunk_bytes_(layout_.chunk_points * layout_.record_bytes()) {
    const std::uint64_t fitting = compression.memory / compression_bytes(layout_);
    chunks_at_once_ = std::clamp<std::uint64_t>(fitting, 1, threads_here());
    records_.reserve(chunks_at_once_ * chunk_bytes_);
    // The offset of the chunk table, which is not known yet.
    out_.write(std::array<std::byte, kOffsetBytes>{});
  }

  void put(std::span<const std::byte> records) override {
    while (!records.empty()) {
      const std::size_t all = chunks_at_once_ * chunk_bytes_;
      const auto fitting = records.first(std::min(records.size(), all - records_.size()));
      records_.insert(records_.end(), fitting.begin(), fitting.end());
      records = records.subspan(fitting.size());
      if (records_.size() == all) write_chunks();
    }
  }

  std::uint64_t finish() override {
    write_chunks();
    const std::uint64_t table_at = points_at_ + bytes_;
    const std::vector<std::byte> table = laz::encode_chunk_table(layout_, chunks_);
    out_.write(table);
    std::array<std::byte, kOffsetBytes> offset;
    store(offset.data(), static_cast<std::int64_t>(table_at));
    out_.overwrite(points_at_, offset);
    return bytes_ + table.size();
  }

 private:
  static constexpr std::size_t kOffsetBytes = sizeof(std::int64_t);

  void write_chunks() {
    const std::span<const std::byte> records = records_;
    std::vector<std::vector<std::byte>> encoded((records.size() + chunk_bytes_ - 1) / chunk_bytes_);
    const auto chunk_of = [&](std::size_t i) {
      const std::size_t begin = i * chunk_bytes_;
      return records.subspan(begin, std::min(chunk_bytes_, records.size() - begin));
    };
    for_each_here(encoded.size(),
                  [&](std::size_t i) { encoded[i] = laz::encode_chunk(layout_, chunk_of(i)); });
    for (std::size_t i = 0; i < encoded.size(); ++i) {
      out_.write(encoded[i]);
      chunks_.push_back({.offset = points_at_ + bytes_,
                         .bytes = encoded[i].size(),
                         .points = chunk_of(i).size() / layout_.record_bytes()});
      bytes_ += encoded[i].size();
    }
    records_.clear();
  }

  OutputFile& out_;
  std::uint64_t points_at_;
  laz::Layout layout_;
  std::size_t chunk_bytes_;  // of records
  std::size_t chunks_at_once_ = 1;
  std::vector<std::byte> records_;  // up to chunks_at_once_ chunks of them
  std::vector<laz::Chunk> chunks_;  // that are written
  std::uint64_t bytes_ = kOffsetBytes;
};

}  // namespace

std::uint64_t compression_bytes(const laz::Layout& layout) {
  // The records, and the compressed chunk as layers and put together.
  constexpr std::uint64_t kCopies = 3;
  return kCopies * layout.chunk_points * layout.record_bytes() + laz::encoder_bytes(layout);
}

std::unique_ptr<LasPointsWriter> las_points_writer(OutputFile& out, std::uint64_t points_at,
                                                   std::optional<LasCompression> compression) {
  if (!compression) return std::make_unique<PlainPointsWriter>(out);
  return std::make_unique<CompressedPointsWriter>(out, points_at, std::move(*compression));
}

}  // namespace lacuna::io
