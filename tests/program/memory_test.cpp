// SPDX-License-Identifier: Apache-2.0
// Memory is bounded by the setting, as the operating system measures it.
#include "engine/config/config.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/drawn_files.hpp"
#include "tests/support/json.hpp"
#include "tests/support/las_file.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

// As doubles.
std::string write_scan(const ScratchFolder& scratch, const Cloud& cloud) {
  std::string ply = ply_header(vertices(cloud.size(), kWideXyz), "binary_little_endian");
  ply.append(reinterpret_cast<const char*>(cloud.positions.data()),
             cloud.size() * sizeof(cloud.positions.front()));
  return scratch.write("scan.ply", ply);
}

// Runs the program with this memory limit, and requires that it ends within it.
ProgramResult run_within(const std::string& limit, const Words& words, int exit_code = 0) {
  const ProgramResult result = run_program(with(words, {"--memory-limit", limit}));
  INFO(result.err);
  REQUIRE(result.exit_code == exit_code);
  CAPTURE(words, result.peak_memory >> 20);  // MiB
  CHECK(result.peak_memory <= *parse_bytes(limit));
  return result;
}

void check_limit(const Cloud& cloud, const Words& more = {}) {
  const ScratchFolder scratch;
  const std::string scan = write_scan(scratch, cloud);
  for (const char* method : {"tangential", "paper"}) {
    const std::string out = (scratch / method).string();
    run_within("64MiB", with({"detect", scan, "--out", out, "--quiet", "--points", "--method", method,
                              "--threads", "2"},
                             more));
  }
}

TEST_CASE("two hundred neighbours of each point stay within the memory limit") {
  check_limit(scattered(20'000, 1), {"--k", "200"});
}

TEST_CASE("the lid of a large hole stays within the memory limit") {
  check_limit(plane(600).punched({300, 300}, 250).jittered(0.2, 1), {"--lids"});
}

TEST_CASE("range images of stations stay within the memory limit, with the same causes as without one",
          "[.slow]") {
  const ScratchFolder scratch;
  const std::string scan = synth("scan", scratch / "room.ply", {"--points", "50000", "--stations", "32"}),
                    stations = (scratch / "room.stations.txt").string(),
                    limited = (scratch / "limited").string();
  run_within("64MiB",
             {"detect", scan, "--out", limited, "--quiet", "--stations", stations, "--threads", "2"});
  detect(scan, scratch / "free", {"--stations", stations});
  CHECK((read_file(scratch / "limited/holes.json") == read_file(scratch / "free/holes.json")));
}

TEST_CASE("a picture stays within the memory limit, and loops that do not fit are refused") {
  const ScratchFolder scratch;
  const std::string scan = write_scan(scratch, plane(600).punched({300, 300}, 250).jittered(0.2, 1)),
                    out = detect(scan, scratch / "out", {"--sample-points", "1000000"}).string();
  const Words render = {"render", out, "--out", (scratch / "a.png").string()};
  run_within("64MiB", with(render, {"--size", "6000x4000"}));
  nlohmann::json holes = read_json(out + "/holes.json");
  nlohmann::json& loops = holes["loops"];
  for (const char* key : {"ids", "coordinates"}) loops[0].erase(key);
  for (int i = 0; i < 30'000; ++i) loops.push_back(loops[0]);
  scratch.write("out/holes.json", holes.dump());
  check_failure(run_within("64MiB", render, 1), 1,
                "loops that fit in the memory limit; --memory-limit states");
}

TEST_CASE("the check of an area stays within the memory limit") {
  const ScratchFolder scratch;
  const std::string scan = synth("surface", scratch / "plane.ply", {"--points", "1000000"}),
                    area = scratch.write(
                        "area.geojson", R"({"type": "Polygon", "coordinates": )"
                                        R"([[[0.1, 0.1], [9.9, 0.1], [9.9, 9.9], [0.1, 9.9], [0.1, 0.1]]]})");
  CHECK_THAT(run_within("112MiB", {"check", scan, "--area", area, "--void-rule", "0.04"}, 1).out,
             Contains("voids: 8 of"));  // exit code 1, since there are some
}

// A star of so many corners, which crosses itself nowhere.
std::string star(int corners) {
  std::string text = R"({"type": "Polygon", "coordinates": [[)", first;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners, radius = 0.7 + 0.01 * (i % 2);
    const std::string corner = "[" + std::to_string(0.85 + radius * std::cos(angle)) + "," +
                               std::to_string(0.85 + radius * std::sin(angle)) + "]";
    if (i == 0) first = corner;
    text += corner + ",";
  }
  return text + first + "]]}";
}

TEST_CASE("an area of many corners stays within the memory limit, or is refused before it is held") {
  const ScratchFolder scratch;
  const std::string scan = synth("surface", scratch / "plane.ply", {"--points", "30000", "--holes", "0"}),
                    area = scratch.write("area.json", star(600'000)),
                    coast = scratch.write("coast.json", star(900'000)),
                    small = scratch.write("small.json", star(9));
  const auto check = [&](const Words& words, int exit_code) {
    return run_within("128MiB", with({"check", scan, "--void-rule", "0.1"}, words), exit_code);
  };
  check({"--area", area, "--out", (scratch / "out").string()}, 0);
  check({"--area", small, "--except", area, "--classes", small}, 0);
  for (const Words& words : {Words{"--area", coast}, Words{"--area", small, "--except", coast},
                             Words{"--area", small, "--classes", area + "," + coast}})
    CHECK_THAT(check(words, 1).err,
               Contains("coast.json: ") && Contains(" corners of polygons") && Contains("allowed: "));
}

TEST_CASE("lacuna-bench score takes the memory of the true holes, however large the found ones are") {
  const ScratchFolder scratch;
  fs::create_directories(scratch / "clouds");
  fs::create_directories(scratch / "loops");
  const std::string clouds = (scratch / "clouds").string();
  synth("surface", clouds + "/s.ply", {"--points", "20000"});
  Random random(1);
  std::string loops;
  for (int loop = 0; loop < 40; ++loop) {  // their surfaces would take 160 MiB
    for (int i = 0; i < 12; ++i) loops += std::to_string(static_cast<int>(random.uniform(0, 19'000))) + " ";
    loops += "\n";
  }
  scratch.write("loops/s.txt", loops);
  const ProgramResult result = run_bench({"score", clouds, (scratch / "loops").string()});
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CAPTURE(result.peak_memory >> 20);  // MiB
  CHECK(result.peak_memory <= 64 << 20);
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
    for (int y = 10 * lane; y < 10 * lane + 5; ++y)
      for (int x = 0; x < length; ++x) put(x, y);
    if (lane + 1 == lanes) break;
    const int turn = lane % 2 == 0 ? length - 5 : 0;
    for (int y = 10 * lane + 5; y < 10 * lane + 10; ++y)
      for (int x = turn; x < turn + 5; ++x) put(x, y);
  }
  return cloud;
}

TEST_CASE("a loop of two hundred thousand points stays within the memory limit") {
  const ScratchFolder scratch;
  const std::string scan = write_scan(scratch, folded_strip(100, 1000)), out = (scratch / "out").string();
  run_within("64MiB", {"detect", scan, "--out", out, "--quiet", "--threads", "2", "--min-confidence", "0",
                       "--every-point"});
  CHECK(fs::file_size(scratch / "out" / "loops.ply") > 5'000'000);
}

TEST_CASE("ten million points and sixteen threads stay within 64 MiB", "[.slow]") {
  const ScratchFolder scratch;
  const std::string scan = synth("surface", scratch / "a.ply", {"--points", "10000000"});
  run_within("64MiB", {"detect", scan, "--out", (scratch / "out").string(), "--quiet", "--threads", "16"});
}

TEST_CASE("sixteen million points stay within 512 MiB, with the same results as without a limit", "[.slow]") {
  const ScratchFolder scratch;
  const std::string scan = synth("surface", scratch / "a.ply", {"--points", "16000000", "--holes", "100"});
  run_within("512MiB", {"detect", scan, "--out", (scratch / "limited").string(), "--quiet"});
  detect(scan, scratch / "free");
  for (const char* file : {"boundary.ply", "loops.ply"})
    CHECK((read_file(scratch / "limited" / file) == read_file(scratch / "free" / file)));
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
std::string laz_of_equal_points(std::uint32_t count) {
  const LasFile las{.points = {las_point(20, 1000, 2000, 3000)}};
  const laz::Layout layout = laz_layout(0, 0, count, 2);
  std::string head = laz_head(las, layout), points;
  put(head, 107, count);
  for (std::uint32_t i = 0; i < count; ++i) points += las.points[0];
  return head + laz_points(layout, points, {count}, head.size());
}

TEST_CASE("LAZ of one large chunk stays within the memory limit") {
  const ScratchFolder scratch;
  run_within("64MiB", {"info", scratch.write("a.laz", laz_of_equal_points(4'000'000)), "--threads", "2"});
}

TEST_CASE("text of 500,000 columns is refused within the memory limit") {
  const ScratchFolder scratch;
  std::string line = "1";
  for (int i = 1; i < 500'000; ++i) line += " 1";
  check_failure(run_within("64MiB", {"info", scratch.write("wide.xyz", line + "\n")}, 1), 1,
                "more than the 10,000 columns that are read");
}

TEST_CASE("an eps ball that cannot fit in memory is refused in one line, before any is searched") {
  const ScratchFolder scratch;
  const std::string scan = write_scan(scratch, plane(300));
  const auto detect = [&](const char* eps) {
    return run_program({"detect", scan, "--out", (scratch / "out").string(), "--quiet", "--eps", eps,
                        "--memory-limit", "64MiB"});
  };
  check_failure(detect("500"), 1, "eps of 500");
  CHECK(detect("3").exit_code == 0);
}

}  // namespace
}  // namespace lacuna::test
