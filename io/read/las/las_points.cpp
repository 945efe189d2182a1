// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_points.hpp"

#include "engine/run/parallel.hpp"
#include "io/read/files/number.hpp"
#include "io/read/las/las_header.hpp"
#include "io/read/laz/laz.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

std::uint64_t file_bytes(const InputFile& in) {
  return in.position() + in.remaining();
}

class PlainPoints final : public LasPoints {
 public:
  PlainPoints(InputFile& in, const LasHeader& header) : in_(in) {
    const std::uint64_t room = in.remaining() / header.record_bytes;
    if (header.points <= room) return;
    in.fail_at_byte(header.points_at, "the header declares " + std::to_string(header.points) + " points of " +
                                          std::to_string(header.record_bytes) + " bytes, but only " +
                                          std::to_string(room) + " follow");
  }

  void read(std::span<std::byte> records) override { in_.read(records.data(), records.size()); }

 private:
  InputFile& in_;
};

// Bytes of a chunk that are read piece by piece.
class ChunkInFile final : public laz::ChunkBytes {
 public:
  ChunkInFile(const InputFile& in, const laz::Chunk& chunk, std::size_t piece)
      : in_(in), chunk_(chunk), piece_(piece) {}

  std::uint64_t size() const override { return chunk_.bytes; }
  std::span<const std::byte> read(std::uint64_t begin, std::uint64_t end,
                                  std::vector<std::byte>& buffer) const override {
    buffer.resize(static_cast<std::size_t>(std::min<std::uint64_t>(end - begin, piece_)));
    in_.read_at(chunk_.offset + begin, buffer);
    return buffer;
  }

 private:
  const InputFile& in_;
  laz::Chunk chunk_;
  std::size_t piece_;
};

// Chunks are decoded whole, several at a time, while they fit into the memory. Else they are decoded one
// after the other, in the blocks that the caller wants.
class CompressedPoints final : public LasPoints {
 public:
  CompressedPoints(const InputFile& in, const LasHeader& header, Trust trust, std::uint64_t memory)
      : in_(in), points_at_(header.points_at), memory_(memory), trusts_header_(trust == Trust::kHeader) {
    if (header.laszip.empty())
      in.fail_at_byte(104, "the points are compressed, but no record says how: 'laszip encoded' is missing");
    locating(points_at_, [&] {
      layout_ = laz::parse_layout(header.laszip);
      if (layout_.record_bytes() != header.record_bytes)
        throw laz::Corrupt("compressed points have " + std::to_string(layout_.record_bytes()) +
                           " bytes, those of the header " + std::to_string(header.record_bytes));
      check_memory();
      chunks_ = find_chunks(header.points);
    });
  }

  void read(std::span<std::byte> records) override {
    while (!records.empty()) {
      const std::size_t count = block_ ? read_block(records) : read_decoded(records);
      if (count == 0) decode_next();
      records = records.subspan(count);
    }
  }

 private:
  struct Block {
    Block(const InputFile& in, const laz::Layout& layout, const laz::Chunk& chunk, std::size_t piece)
        : chunk(chunk), bytes(in, chunk, piece), decoder(layout, bytes), left(chunk.points) {}

    laz::Chunk chunk;
    ChunkInFile bytes;
    laz::ChunkDecoder decoder;
    std::uint64_t left;  // points
  };

  // Adds the place if the data are corrupt.
  template <class Work>
  void locating(std::uint64_t byte, Work&& work) const {
    try {
      work();
    } catch (const laz::Corrupt& corrupt) {
      in_.fail_at_byte(byte, corrupt.what());
    }
  }

  void check_memory() const {
    const std::uint64_t needed = laz::decoder_bytes(layout_) + piece_bytes() * laz::stream_count(layout_);
    if (needed <= memory_) return;
    throw laz::Corrupt("to decompress points of " + std::to_string(layout_.record_bytes()) + " bytes takes " +
                       std::to_string(needed >> 20) + " MiB, more than the " + std::to_string(memory_ >> 20) +
                       " MiB that the memory limit leaves for it; allowed: " + "a higher memory limit");
  }

  // Bytes of a stream that are read at a time.
  std::size_t piece_bytes() const {
    constexpr std::size_t kAll = std::size_t{1} << 20, kLeast = 512, kMost = std::size_t{1} << 16;
    return std::clamp(kAll / laz::stream_count(layout_), kLeast, kMost);
  }

  std::vector<laz::Chunk> find_chunks(std::uint64_t points) const {
    if (points == 0) return {};
    const std::uint64_t end = file_bytes(in_);
    const std::uint64_t table_at = find_table(end);
    std::array<std::byte, 8> head;
    in_.read_at(table_at, head);
    std::vector<std::byte> table(std::min(laz::chunk_table_bytes(head), end - table_at));
    in_.read_at(table_at, table);
    return laz::read_chunk_table(layout_, table, points_at_ + 8, table_at, points);
  }

  // Returns where the chunk table begins. The offset is before the first chunk. A writer that could not go
  // back puts it at the end of the file.
  std::uint64_t find_table(std::uint64_t end) const {
    constexpr std::uint64_t kOffset = sizeof(std::int64_t);
    if (end < points_at_ + 2 * kOffset) throw laz::Corrupt("the file ends before the compressed points");
    std::int64_t offset = 0;
    const std::span<std::byte> bytes = std::as_writable_bytes(std::span(&offset, 1));
    in_.read_at(points_at_, bytes);
    if (offset <= static_cast<std::int64_t>(points_at_)) in_.read_at(end - kOffset, bytes);
    const bool is_behind = offset >= static_cast<std::int64_t>(points_at_ + kOffset);
    if (!is_behind || static_cast<std::uint64_t>(offset) + 8 > end)
      throw laz::Corrupt("the chunk table is said to begin at byte " + std::to_string(offset) +
                         ", which is not behind the points; the file may be cut");
    return static_cast<std::uint64_t>(offset);
  }

  // Both functions return the number of bytes, 0 at the end of the decoded data.
  std::size_t read_decoded(std::span<std::byte> records) {
    const std::span<const std::byte> ready = std::span(decoded_).subspan(taken_);
    const std::size_t count = std::min(records.size(), ready.size());
    std::copy_n(ready.begin(), count, records.begin());
    taken_ += count;
    return count;
  }

  std::size_t read_block(std::span<std::byte> records) {
    const std::size_t record_bytes = layout_.record_bytes();
    const auto points =
        static_cast<std::size_t>(std::min<std::uint64_t>(block_->left, records.size() / record_bytes));
    const std::size_t count = points * record_bytes;
    block_->left -= points;
    locating(block_->chunk.offset, [&] {
      block_->decoder.decode(records.first(count));
      if (block_->left == 0) check_end(block_->chunk, block_->decoder);
    });
    if (block_->left == 0) block_.reset();
    return count;
  }

  std::uint64_t bytes_in_memory(const laz::Chunk& chunk) const {
    return chunk.bytes + chunk.points * layout_.record_bytes() + laz::decoder_bytes(layout_);
  }

  // Decodes the next chunks, in memory or block by block.
  void decode_next() {
    if (next_chunk_ == chunks_.size())
      in_.fail_at_byte(file_bytes(in_), "the chunks hold fewer points than the header declares");
    if (const laz::Chunk& next = chunks_[next_chunk_]; bytes_in_memory(next) > memory_) {
      block_.emplace(in_, layout_, next, piece_bytes());
      ++next_chunk_;
    } else {
      decode_together(next_chunks());
    }
  }

  // Returns a few chunks for each thread, so that no thread idles long for the others.
  std::span<const laz::Chunk> next_chunks() {
    constexpr std::size_t kForEachThread = 4;
    constexpr std::uint64_t kEnough = std::uint64_t{32} << 20;  // bytes in memory
    const std::span<const laz::Chunk> left = std::span(chunks_).subspan(next_chunk_);
    const std::size_t threads = threads_here();
    std::uint64_t bytes = 0;
    std::size_t count = 0;
    for (; count < std::min(left.size(), kForEachThread * threads); ++count) {
      bytes += bytes_in_memory(left[count]);
      if (bytes > memory_ || (count >= threads && bytes > kEnough)) break;
    }
    next_chunk_ += count;
    return left.first(count);
  }

  void decode_together(std::span<const laz::Chunk> chunks) {
    std::vector<std::size_t> places = {0};  // of the chunks' records
    for (const laz::Chunk& chunk : chunks)
      places.push_back(places.back() + static_cast<std::size_t>(chunk.points) * layout_.record_bytes());
    decoded_.resize(places.back());
    taken_ = 0;
    // The first error by position counts, whichever thread comes by first.
    std::vector<std::exception_ptr> errors(chunks.size());
    for_each_here(chunks.size(), [&](std::size_t i) {
      try {
        std::vector<std::byte> bytes(chunks[i].bytes);
        in_.read_at(chunks[i].offset, bytes);
        const laz::ChunkInMemory in_memory(bytes);
        locating(chunks[i].offset, [&] {
          laz::ChunkDecoder decoder(layout_, in_memory);
          decoder.decode(std::span(decoded_).subspan(places[i], places[i + 1] - places[i]));
          check_end(chunks[i], decoder);
        });
      } catch (...) {
        errors[i] = std::current_exception();
      }
    });
    for (const std::exception_ptr& error : errors) {
      if (error) std::rethrow_exception(error);
    }
  }

  // Refuses a chunk with other points than are counted.
  void check_end(const laz::Chunk& chunk, laz::ChunkDecoder& decoder) const {
    if (!trusts_header_ && decoder.has_other_than(chunk.points))
      throw laz::Corrupt("a chunk does not end with the " + std::to_string(chunk.points) +
                         " points that header and chunk table count; --trust header reads these, and "
                         "`laszip` or `lasinfo -repair` count the others");
  }

  const InputFile& in_;
  std::uint64_t points_at_, memory_;
  bool trusts_header_;
  laz::Layout layout_{};
  std::vector<laz::Chunk> chunks_;
  std::size_t next_chunk_ = 0;
  std::vector<std::byte> decoded_;  // whole chunks
  std::size_t taken_ = 0;           // bytes of them
  std::optional<Block> block_;      // the chunk that is decoded block by block
};

}  // namespace

std::unique_ptr<LasPoints> las_points(InputFile& in, const LasHeader& header, Trust trust,
                                      std::uint64_t memory) {
  if (header.is_compressed) return std::make_unique<CompressedPoints>(in, header, trust, memory);
  return std::make_unique<PlainPoints>(in, header);
}

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

namespace {

constexpr int kCompressed = 0x80;  // of the point format

bool goes_over(const LasRecordExtent& record) {
  if (record.user == kLaszip || record.user == "copc") return false;
  return record.user != kLasSpecification || record.number != kLasExtraBytes;
}

// Returns the header as LAS 1.4 has it.
std::string header_of(const LasHeader& from, std::size_t record_bytes) {
  std::string header(kLasHeaderBytes[4], '\0');
  const std::size_t bytes =
      kLasHeaderBytes.at(std::min(static_cast<std::size_t>(from.minor), std::size_t{4}));
  std::memcpy(header.data(), from.bytes.data(), bytes);
  // These fields were reserved before these versions.
  if (from.minor < 1) put_at<std::uint16_t>(header, 4, 0);
  if (from.minor < 2) put_at<std::uint16_t>(header, 6, 0);
  header.append(reinterpret_cast<const char*>(from.bytes.data()) + bytes, from.bytes.size() - bytes);
  put_at<std::uint8_t>(header, 24, 1);
  put_at<std::uint8_t>(header, 25, 4);
  put_text(header, 58, 32, "Lacuna " LACUNA_VERSION);  // generating software
  put_at(header, 94, static_cast<std::uint16_t>(header.size()));
  put_at(header, 104, static_cast<std::uint8_t>(from.point_format));
  put_at(header, 105, static_cast<std::uint16_t>(record_bytes));
  return header;
}

}  // namespace

LasWriter::LasWriter(OutputFile& out, const std::filesystem::path& file, const LasHeader& from,
                     std::span<const LasExtraBytes> extra, std::size_t record_bytes,
                     std::optional<LasCompression> compression)
    : out_(out),
      file_(file),
      from_(from),
      record_bytes_(record_bytes),
      header_(header_of(from, record_bytes)) {
  if (compression) put_at(header_, 104, static_cast<std::uint8_t>(from.point_format | kCompressed));
  out_.write(header_);
  written_ = header_.size();
  write_records(extra, compression);
  put_at(header_, 96, static_cast<std::uint32_t>(written_));
  put_at(header_, 100, records_);
  points_out_ = las_points_writer(out_, written_, std::move(compression));
}

void LasWriter::write_records(std::span<const LasExtraBytes> extra,
                              const std::optional<LasCompression>& compression) {
  const auto write = [&](std::string_view user, std::uint16_t number, std::string_view data,
                         std::string_view description) {
    out_.write(las_record_head(user, number, static_cast<std::uint16_t>(data.size()), description));
    out_.write(data);
    written_ += kLasRecordHead + data.size();
    ++records_;
  };
  for (const LasRecordExtent& record : from_.records) {
    if (!goes_over(record)) continue;
    written_ += copy_las_record(file_, record, out_);
    ++records_;
  }
  std::string descriptors;
  for (const LasExtraBytes& one : extra)
    descriptors.append(reinterpret_cast<const char*>(one.descriptor.data()), one.descriptor.size());
  if (!extra.empty()) write(kLasSpecification, kLasExtraBytes, descriptors, "Extra Bytes Record");
  if (compression) {
    const std::vector<std::byte> layout = laz::layout_record(compression->layout);
    write(kLaszip, kLaszipLayout, {reinterpret_cast<const char*>(layout.data()), layout.size()}, "LASzip");
  }
}

void LasWriter::put_rows(std::span<const std::byte> records) {
  points_out_->put(records);
  points_ += records.size() / record_bytes_;
  constexpr std::size_t kReturnAt = 14;
  const auto mask = static_cast<std::byte>(from_.point_format < 6 ? 7 : 15);
  for (std::size_t at = kReturnAt; at < records.size(); at += record_bytes_)
    ++of_return_[std::to_integer<std::size_t>(records[at] & mask)];
}

void LasWriter::write_extended() {
  extended_at_ = written_;
  const auto waveforms_at = value_at<std::uint64_t>(header_, 227);  // 0 without them
  put_at(header_, 227, std::uint64_t{0});
  for (const LasRecordExtent& record : from_.extended) {
    if (!goes_over(record)) continue;
    if (record.at == waveforms_at) put_at(header_, 227, written_);
    written_ += copy_las_record(file_, record, out_);
    ++extended_;
  }
}

void LasWriter::complete_header() {
  put_at(header_, 235, extended_ > 0 ? extended_at_ : std::uint64_t{0});
  put_at(header_, 243, extended_);
  put_at(header_, 247, points_);
  if (points_ != from_.points) return count_anew();
  if (from_.minor >= 4) return;
  // Counts of returns have 64 bits since LAS 1.4.
  for (std::size_t i = 0; i < 5; ++i)
    put_at(header_, 255 + 8 * i, std::uint64_t{value_at<std::uint32_t>(header_, 111 + 4 * i)});
}

// The counts of the other header do not hold. Formats from 6 on have no counts of 32 bits, and neither has a
// file of more points.
void LasWriter::count_anew() {
  const bool has_few = from_.point_format < 6 && points_ <= std::numeric_limits<std::uint32_t>::max();
  const auto few = [&](std::uint64_t count) { return static_cast<std::uint32_t>(has_few ? count : 0); };
  put_at(header_, 107, few(points_));
  for (std::size_t i = 0; i < 15; ++i) put_at(header_, 255 + 8 * i, of_return_[i + 1]);
  for (std::size_t i = 0; i < 5; ++i) put_at(header_, 111 + 4 * i, few(of_return_[i + 1]));
}

void LasWriter::finish() {
  written_ += points_out_->finish();
  write_extended();
  complete_header();
  out_.overwrite_start(header_);
}

}  // namespace lacuna::io
