// SPDX-License-Identifier: Apache-2.0
// Memory is bounded by the setting, as the operating system measures it.
#include "engine/config/config.hpp"
#include "io/laz/laz_encoder.hpp"
#include "tests/io/las/las_file.hpp"
#include "tests/support/hostile.hpp"
#include "tests/support/laz_data.hpp"
#include "tests/support/run_program.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <span>

#include <catch2/catch.hpp>

namespace lacuna {
using namespace io;

namespace {

namespace fs = std::filesystem;
using test::with;
using test::Words;

// As doubles.
std::string write_scan(const test::ScratchFolder& scratch, const Cloud& cloud) {
  std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(cloud.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  ply.append(reinterpret_cast<const char*>(cloud.positions.data()),
             cloud.size() * sizeof(cloud.positions.front()));
  return scratch.write("scan.ply", ply);
}

// Runs the program with this memory limit, and requires that it succeeds within it.
test::ProgramResult run_within(const std::string& limit, const Words& words) {
  const test::ProgramResult result = test::run_program(with(words, {"--memory-limit", limit}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CAPTURE(words, result.peak_memory >> 20);  // MiB
  CHECK(result.peak_memory <= *parse_bytes(limit));
  return result;
}

void check_limit(const Cloud& cloud, const Words& more = {}) {
  const test::ScratchFolder scratch;
  const std::string scan = write_scan(scratch, cloud);
  for (const char* method : {"tangential", "paper"}) {
    const std::string out = (scratch / method).string();
    run_within("64MiB", with({"detect", scan, "--out", out, "--quiet", "--points", "--method", method,
                              "--threads", "2"},
                             more));
  }
}

TEST_CASE("a volume of random points stays within the memory limit") {
  check_limit(volume(200'000, 1));
}

TEST_CASE("two hundred neighbours of each point stay within the memory limit") {
  check_limit(scattered(20'000, 1), {"--k", "200"});
}

TEST_CASE("the lid of a large hole stays within the memory limit") {
  check_limit(plane(600).punched({300, 300}, 250).jittered(0.2, 1), {"--lids"});
}

TEST_CASE("range images of stations stay within the memory limit, with the same causes as without one") {
  const test::ScratchFolder scratch;
  const std::string scan = (scratch / "room.ply").string(),
                    stations = (scratch / "room.stations.txt").string();
  REQUIRE(test::run_bench({"synth", "scan", scan, "--points", "50000", "--stations", "32"}).exit_code == 0);
  const std::string limited = (scratch / "limited").string();
  run_within("64MiB",
             {"detect", scan, "--out", limited, "--quiet", "--stations", stations, "--threads", "2"});
  test::detect(scan, scratch / "free", {"--stations", stations});
  CHECK((test::read_file(scratch / "limited/holes.json") == test::read_file(scratch / "free/holes.json")));
}

TEST_CASE("the check of an area stays within the memory limit") {
  const test::ScratchFolder scratch;
  const std::string scan = (scratch / "plane.ply").string(),
                    area = scratch.write(
                        "area.geojson", R"({"type": "Polygon", "coordinates": )"
                                        R"([[[0.1, 0.1], [9.9, 0.1], [9.9, 9.9], [0.1, 9.9], [0.1, 0.1]]]})");
  REQUIRE(test::run_bench({"synth", "surface", scan, "--points", "1000000"}).exit_code == 0);
  const test::ProgramResult result =
      test::run_program({"check", scan, "--area", area, "--void-rule", "0.04", "--memory-limit", "112MiB"});
  CHECK_THAT(result.out, Catch::Matchers::Contains("voids: 8 of"));
  CAPTURE(result.peak_memory >> 20);  // MiB
  CHECK(result.peak_memory <= 112 << 20);
}

TEST_CASE("a scan thinned in several shares stays within the memory limit") {
  check_limit(volume(300'000, 1), {"--resolution", "0.01"});
}

TEST_CASE("a million equal points stay within the memory limit") {
  check_limit(scattered(60'000, 1).joined(coincident(1'000'000)));
}

TEST_CASE("nine tenths of the points within a millionth of the extent stay within the memory limit") {
  check_limit(cluster(200'000, 1));
}

TEST_CASE("far outliers stay within the memory limit") {
  Random random(1);
  Cloud cloud = plane(400).shuffled(1);
  const auto far = [&] { return 1e6 * std::tan(random.uniform(-1.57, 1.57)); };
  for (std::size_t i = 0; i < cloud.size(); i += 20) cloud.positions[i] = {far(), far(), far()};
  check_limit(cloud);
}

// A strip of five points in zigzag: its outer curve passes through two points in five.
Cloud folded_strip(int lanes, int length) {
  Cloud cloud;
  Random random(1);
  const auto put = [&](int x, int y) {
    cloud.positions.push_back({x + random.uniform(-0.15, 0.15), y + random.uniform(-0.15, 0.15), 0});
  };
  for (int lane = 0; lane < lanes; ++lane) {
    for (int y = 10 * lane; y < 10 * lane + 5; ++y) {
      for (int x = 0; x < length; ++x) put(x, y);
    }
    if (lane + 1 == lanes) break;
    const int turn = lane % 2 == 0 ? length - 5 : 0;
    for (int y = 10 * lane + 5; y < 10 * lane + 10; ++y) {
      for (int x = turn; x < turn + 5; ++x) put(x, y);
    }
  }
  return cloud;
}

TEST_CASE("a loop of two hundred thousand points stays within the memory limit") {
  const test::ScratchFolder scratch;
  const std::string scan = write_scan(scratch, folded_strip(100, 1000)), out = (scratch / "out").string();
  run_within("64MiB", {"detect", scan, "--out", out, "--quiet", "--threads", "2", "--obj", "--min-confidence",
                       "0", "--every-point"});
  CHECK(fs::file_size(scratch / "out" / "loops.ply") > 5'000'000);
}

TEST_CASE("ten million points and sixteen threads stay within 64 MiB", "[.slow]") {
  const test::ScratchFolder scratch;
  const std::string scan = (scratch / "surface.ply").string();
  REQUIRE(test::run_bench({"synth", "surface", scan, "--points", "10000000"}).exit_code == 0);
  run_within("64MiB", {"detect", scan, "--out", (scratch / "out").string(), "--quiet", "--threads", "16"});
}

void check_memory(const std::string& points, const std::string& limit) {
  const test::ScratchFolder scratch;
  const std::string scan = (scratch / "surface.ply").string();
  REQUIRE(test::run_bench({"synth", "surface", scan, "--points", points, "--holes", "100"}).exit_code == 0);
  run_within(limit, {"detect", scan, "--out", (scratch / "limited").string(), "--quiet"});
  test::detect(scan, scratch / "free");
  for (const char* file : {"boundary.ply", "loops.ply"})
    CHECK((test::read_file(scratch / "limited" / file) == test::read_file(scratch / "free" / file)));
}

TEST_CASE("sixteen million points stay within 512 MiB, with the same results as without a limit", "[.slow]") {
  check_memory("16000000", "512MiB");
}

TEST_CASE("four million points stay within 256 MiB, with the same results as without a limit", "[.slow]") {
  check_memory("4000000", "256MiB");
}

// Large enough that the points alone would fill the limit.
constexpr int kMany = 2'000'000;

TEST_CASE("two million points, however uneven they lie, stay within the memory limit", "[.slow]") {
  struct Shape {
    const char* name;
    Cloud (*draw)(int, std::uint64_t);
  };
  const auto [name, draw] =
      GENERATE(Shape{"a volume", volume}, Shape{"a volume in a millionth", volume_cluster},
               Shape{"a sheet in a millionth", cluster}, Shape{"six decades", log_uniform},
               Shape{"a line", random_line}, Shape{"most at the origin", zeros},
               Shape{"one in a hundred far away", one_percent_far});
  INFO(name);
  check_limit(draw(kMany, 1));
}

// A file of few bytes: LAZ codes points that are alike in next to none.
std::string laz_of_equal_points(std::uint32_t count, bool has_chunks) {
  const std::string point = test::las_point(20, 1000, 2000, 3000);
  laz::Layout layout = test::laz_layout(0, 0, count, 2);
  if (!has_chunks) layout.compressor = laz::compressor::kPointwise;
  const auto text = [](const test::LazBytes& bytes) {
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  const test::LasFile las{
      .points = {point},
      .records = {test::las_record("laszip encoded", 22204, text(laz::layout_record(layout)))}};
  std::string bytes = las.bytes();
  bytes.resize(bytes.size() - point.size());
  test::put(bytes, 104, std::uint8_t{0x80});
  test::put(bytes, 107, count);
  std::string points;
  for (std::uint32_t i = 0; i < count; ++i) points += point;
  const std::span records = std::as_bytes(std::span(points));
  return bytes + text(has_chunks ? test::laz_point_data(layout, records, std::array{std::uint64_t{count}},
                                                        bytes.size())
                                 : test::laz_chunk(layout, records));
}

void check_laz_of_one_chunk(std::uint32_t points) {
  const test::ScratchFolder scratch;
  for (const bool has_chunks : {true, false}) {
    INFO("chunks: " << has_chunks);
    const std::string scan = scratch.write("a.laz", laz_of_equal_points(points, has_chunks));
    run_within("64MiB", {"info", scan, "--threads", "2"});
  }
}

TEST_CASE("LAZ of one large chunk stays within the memory limit, with and without a chunk table") {
  check_laz_of_one_chunk(4'000'000);
}

TEST_CASE("LAZ of one chunk of 15 million points, 286 MiB, stays within the memory limit", "[.slow]") {
  check_laz_of_one_chunk(15'000'000);
}

TEST_CASE("text of 500,000 columns is refused within the memory limit") {
  const test::ScratchFolder scratch;
  std::string line = "1";
  for (int i = 1; i < 500'000; ++i) line += " 1";
  const test::ProgramResult result =
      test::run_program({"info", scratch.write("wide.xyz", line + "\n"), "--memory-limit", "64MiB"});
  test::check_failure(result, 1, "more than the 10,000 columns that are read");
  CHECK(result.peak_memory <= 64 << 20);
}

TEST_CASE("an eps ball that cannot fit in memory is refused in one line, before any is searched") {
  const test::ScratchFolder scratch;
  const std::string scan = write_scan(scratch, plane(300));
  const auto detect = [&](const char* eps) {
    return test::run_program({"detect", scan, "--out", (scratch / "out").string(), "--quiet", "--eps", eps,
                              "--memory-limit", "64MiB"});
  };
  test::check_failure(detect("500"), 1, "eps of 500");
  CHECK(detect("3").exit_code == 0);
}

}  // namespace
}  // namespace lacuna
