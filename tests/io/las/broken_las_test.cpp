// SPDX-License-Identifier: Apache-2.0
// Broken files of every point format, compressed and not.
#include "engine/run/parallel.hpp"
#include "io/read/formats.hpp"
#include "io/read/las/las_header.hpp"
#include "io/read/laz/laz.hpp"
#include "tests/io/broken_files.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {
namespace {

// With two extra bytes, and a record that describes them.
LasFile las_file(int minor, int format, std::size_t points) {
  return {.minor = minor,
          .format = format,
          .points = las_points_alike(las_point_bytes(format) + 2, points),
          .records = {las_record("LASF_Spec", 4, las_extra_descriptor("width", 3, 8 + 16, 0.5, 100))}};
}

WholeFile plain(int minor, int format) {
  const std::string bytes = las_file(minor, format, 3).bytes();
  return {.name = "format_" + std::to_string(format) + ".las", .bytes = bytes, .complete_from = bytes.size()};
}

// `version` of the items; `chunks`: the points of each.
WholeFile compressed(int minor, int format, std::uint16_t version, const std::vector<std::uint64_t>& chunks) {
  const LasFile las =
      las_file(minor, format, std::accumulate(chunks.begin(), chunks.end(), std::uint64_t{0}));
  const bool varies = chunks.front() < *std::max_element(chunks.begin(), chunks.end());
  const auto chunk_points = varies ? laz::kVariableChunks : static_cast<std::uint32_t>(chunks.front());
  const laz::Layout layout = laz_layout(format, 2, chunk_points, version);
  const std::string bytes = laz_file(las, layout, chunks);
  // LASzip codes a point in as little as 1/4096 byte: a file of 1 KB may have 4 million points of 40 bytes.
  return {.name = "format_" + std::to_string(format) + "_version_" + std::to_string(version) + ".laz",
          .bytes = bytes,
          .complete_from = bytes.size(),
          .points_in_a_byte = 4096,
          .megabytes = 300};
}

// Sets the number of points that the header states.
void set_count(int format, std::uint64_t count, std::string& bytes) {
  if (format < 6) {
    put(bytes, 107, static_cast<std::uint32_t>(count));
  } else {
    put(bytes, 247, count);
  }
}

const std::vector<std::uint64_t> kFixed = {8, 8, 3}, kVarying = {2, 9, 1};

TEST_CASE("LAZ with two broken chunks: the error names the first, however many threads decode", "[io]") {
  constexpr std::size_t kPoints = 20'000;
  const LasFile las = las_file(2, 0, 2 * kPoints);
  const laz::Layout layout = laz_layout(0, 2, kPoints, 2);
  std::string bytes = laz_head(las, layout), points;
  for (const std::string& point : las.points) points += point;
  const std::size_t half = points.size() / 2, points_at = bytes.size();
  // The first breaks at its end, the second at its beginning, so that its error comes first.
  std::string first = text_of(laz::encode_chunk(layout, std::as_bytes(std::span(points).first(half))));
  std::string second = text_of(laz::encode_chunk(layout, std::as_bytes(std::span(points).last(half))));
  first.resize(first.size() - 100);
  put(second, las.points[0].size(), std::uint32_t{0xffffffff});
  const std::vector<laz::Chunk> chunks = {{0, first.size(), kPoints}, {0, second.size(), kPoints}};
  put(bytes, points_at, std::uint64_t{points_at + 8 + first.size() + second.size()});
  bytes += first + second + text_of(laz::encode_chunk_table(layout, chunks));

  const ScratchFolder folder;
  const auto file = folder.write("a.laz", bytes);
  for (const std::size_t threads : {1u, 2u, 8u}) {
    std::string error;
    TaskArena(threads).for_each(1, [&](std::size_t) { error = read_error(file); });
    CHECK_THAT(error,
               EndsWith("byte " + std::to_string(points_at + 8) + ": the compressed points end too early"));
  }
}

TEST_CASE("LAZ gives the same points, whether its chunks fit into the memory or not", "[io]") {
  const ScratchFolder folder;
  for (const WholeFile& file : {compressed(2, 3, 2, {60'000, 60'000}), compressed(4, 7, 3, {60'000, 5})}) {
    const auto path = folder.write("a.laz", file.bytes);
    INFO(file.name);
    // Little more than what the models take, and much more than a chunk.
    const Table blocks = read_table(path, 999, {.columns = "", .memory = 3 << 20});
    const Table whole = read_table(path, 999, {.columns = "", .memory = 64 << 20});
    CHECK(blocks.rows.size() == whole.rows.size());
    CHECK(std::equal(blocks.rows.begin(), blocks.rows.end(), whole.rows.begin(), whole.rows.end(),
                     same_numbers));
  }
}

TEST_CASE("LAZ whose header counts fewer points than its last chunk has is an error, unless it is trusted",
          "[io]") {
  const ScratchFolder folder;
  for (const int format : {3, 7}) {
    WholeFile file = compressed(format < 6 ? 2 : 4, format, format < 6 ? 2 : 3, {30'000, 30'000});
    set_count(format, 50'000, file.bytes);
    const auto path = folder.write("a.laz", file.bytes);
    for (const std::uint64_t memory : {3 << 20, 64 << 20}) {  // by blocks, whole
      INFO(file.name << " within " << memory);
      CHECK_THAT(error_of([&] { read_table(path, 999, {.columns = "", .memory = memory}); }),
                 Contains("a chunk does not end with the 20000 points"));
      const ReadOptions trusting{.columns = "", .memory = memory, .trust = Trust::kHeader};
      CHECK(read_table(path, 999, trusting).rows.size() == 50'000);
    }
  }
}

TEST_CASE("LAZ: every count that is too small for the only chunk is an error", "[io]") {
  for (const int format : {0, 1, 2, 3, 6, 7, 8}) {
    for (const std::uint16_t version : {format < 6 ? 2 : 3, format < 6 ? 2 : 4}) {
      WholeFile file = compressed(format < 6 ? 2 : 4, format, version, {500});
      for (const std::uint64_t count : {1, 2, 250, 490, 495, 496, 497, 498, 499}) {
        set_count(format, count, file.bytes);
        check_refused("a.laz",
                      {{file.bytes, "a chunk does not end with the " + std::to_string(count) + " "}});
      }
    }
  }
}

TEST_CASE("LAZ whose models alone take more than the memory is an error at once", "[io]") {
  const ScratchFolder folder;
  const auto file = folder.write("a.laz", compressed(2, 3, 2, kFixed).bytes);
  CHECK_THAT(error_of([&] { open_scan(file, {.columns = "", .memory = 1 << 20}); }),
             Contains("allowed: a higher memory limit"));
}

}  // namespace

std::vector<WholeFile> some_las_files() {
  return {plain(0, 1), plain(4, 7), compressed(2, 3, 2, kFixed), compressed(4, 7, 3, kVarying)};
}

std::vector<WholeFile> all_las_files() {
  std::vector<WholeFile> files;
  for (int format = 0; format <= 10; ++format) files.push_back(plain(format < 6 ? format % 4 : 4, format));
  for (const int format : {0, 1, 2, 3}) {
    for (const auto& chunks : {kFixed, kVarying}) files.push_back(compressed(2, format, 2, chunks));
  }
  for (const int format : {6, 7, 8}) {
    for (const std::uint16_t version : {3, 4})
      for (const auto& chunks : {kFixed, kVarying}) files.push_back(compressed(4, format, version, chunks));
  }
  return files;
}

}  // namespace lacuna::test
