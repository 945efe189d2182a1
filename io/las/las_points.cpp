#include "io/las/las_points.hpp"

#include "engine/run/parallel.hpp"
#include "io/laz/laz.hpp"

#include <algorithm>
#include <array>
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

class CompressedPoints final : public LasPoints {
 public:
  CompressedPoints(const std::filesystem::path& file, InputFile& in, const LasHeader& header)
      : in_(in), points_at_(header.points_at) {
    if (header.laszip.empty())
      in.fail_at_byte(104, "the points are compressed, but no record says how: 'laszip encoded' is missing");
    locating(points_at_, [&] {
      layout_ = laz::parse_layout(header.laszip);
      if (layout_.record_bytes() != header.record_bytes)
        throw laz::Corrupt("compressed points have " + std::to_string(layout_.record_bytes()) +
                           " bytes, those of the header " + std::to_string(header.record_bytes));
      find_chunks(file, header.points);
    });
  }

  void read(std::span<std::byte> records) override {
    while (!records.empty()) {
      if (taken_ == decoded_.size()) decode_next();
      const std::span<const std::byte> ready = std::span(decoded_).subspan(taken_);
      const std::size_t count = std::min(records.size(), ready.size());
      std::copy_n(ready.begin(), count, records.begin());
      taken_ += count;
      records = records.subspan(count);
    }
  }

 private:
  // Says where, if the data are corrupt.
  template <class Work>
  void locating(std::uint64_t byte, Work&& work) {
    try {
      work();
    } catch (const laz::Corrupt& corrupt) {
      in_.fail_at_byte(byte, corrupt.what());
    }
  }

  void find_chunks(const std::filesystem::path& file, std::uint64_t points) {
    if (points == 0) return;
    const std::uint64_t end = file_bytes(in_);
    if (layout_.compressor == laz::compressor::kPointwise) {
      const std::uint64_t bytes = end - points_at_;
      if (points > laz::kMostPointsInAByte * bytes)
        throw laz::Corrupt(std::to_string(points) + " points in only " + std::to_string(bytes) + " bytes");
      chunks_ = {{points_at_, bytes, points}};
    } else {
      const std::uint64_t table_at = find_table(file, end);
      InputFile again(file);
      again.skip(table_at);
      std::array<std::byte, 8> head;
      again.read(head.data(), head.size());
      std::vector<std::byte> table(std::min(laz::chunk_table_bytes(head), end - table_at));
      if (table.size() < head.size()) throw laz::Corrupt("the chunk table is cut");
      std::copy(head.begin(), head.end(), table.begin());
      again.read(table.data() + head.size(), table.size() - head.size());
      chunks_ = laz::read_chunk_table(layout_, table, points_at_ + 8, table_at, points);
    }
    constexpr std::uint64_t kMostBytes = std::uint64_t{256} << 20;
    for (const laz::Chunk& chunk : chunks_) {
      if (chunk.points > kMostBytes / layout_.record_bytes() || chunk.bytes > kMostBytes)
        in_.fail_at_byte(chunk.offset, "a chunk of " + std::to_string(chunk.points) +
                                           " points is larger than 256 MiB; LASzip writes chunks of 50,000");
    }
  }

  // Where the chunk table begins: named before the first chunk, or by a writer that could not go back at the
  // end.
  std::uint64_t find_table(const std::filesystem::path& file, std::uint64_t end) {
    constexpr std::uint64_t kOffset = sizeof(std::int64_t);
    if (end < points_at_ + 2 * kOffset) throw laz::Corrupt("the file ends before the compressed points");
    std::int64_t offset = 0;
    in_.read(reinterpret_cast<std::byte*>(&offset), kOffset);
    if (offset <= static_cast<std::int64_t>(points_at_)) {
      InputFile again(file);
      again.skip(end - kOffset);
      again.read(reinterpret_cast<std::byte*>(&offset), kOffset);
    }
    const bool is_behind = offset >= static_cast<std::int64_t>(points_at_ + kOffset);
    if (!is_behind || static_cast<std::uint64_t>(offset) + 8 > end)
      throw laz::Corrupt("the chunk table is said to begin at byte " + std::to_string(offset) +
                         ", which is not behind the points; the file may be cut");
    return static_cast<std::uint64_t>(offset);
  }

  // The next chunks, a few for each thread, so that none waits long for the others.
  void decode_next() {
    constexpr std::size_t kForEachThread = 4;
    constexpr std::size_t kEnough = std::size_t{16} << 20;  // bytes of records
    const std::size_t first = next_chunk_;
    std::vector<std::vector<std::byte>> bytes;
    std::vector<std::size_t> places = {0};  // of the chunks' records
    while (next_chunk_ < chunks_.size() && bytes.size() < kForEachThread * threads_here() &&
           (bytes.size() < threads_here() || places.back() < kEnough)) {
      const laz::Chunk& chunk = chunks_[next_chunk_++];
      if (chunk.offset < in_.position()) in_.fail_at_byte(chunk.offset, "a chunk within the one before");
      in_.skip(chunk.offset - in_.position());
      if (chunk.bytes > in_.remaining()) in_.fail_at_byte(chunk.offset, "the file ends here, within a chunk");
      in_.read(bytes.emplace_back(chunk.bytes).data(), chunk.bytes);
      places.push_back(places.back() + chunk.points * layout_.record_bytes());
    }
    decoded_.resize(places.back());
    taken_ = 0;
    for_each_here(bytes.size(), [&](std::size_t i) {
      const laz::Chunk& chunk = chunks_[first + i];
      locating(chunk.offset, [&] {
        laz::decode_chunk(layout_, bytes[i], chunk.points,
                          std::span(decoded_).subspan(places[i], places[i + 1] - places[i]));
      });
    });
    if (decoded_.empty() && next_chunk_ == chunks_.size())
      in_.fail_at_byte(in_.position(), "the chunks hold fewer points than the header declares");
  }

  InputFile& in_;
  std::uint64_t points_at_;
  laz::Layout layout_{};
  std::vector<laz::Chunk> chunks_;
  std::size_t next_chunk_ = 0;
  std::vector<std::byte> decoded_;
  std::size_t taken_ = 0;  // bytes of it
};

}  // namespace

std::unique_ptr<LasPoints> las_points(const std::filesystem::path& file, InputFile& in,
                                      const LasHeader& header) {
  if (header.is_compressed) return std::make_unique<CompressedPoints>(file, in, header);
  return std::make_unique<PlainPoints>(in, header);
}

}  // namespace lacuna::io
