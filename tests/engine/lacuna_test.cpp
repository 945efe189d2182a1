// SPDX-License-Identifier: Apache-2.0
// The library's few functions against each other, and against the program.
#include "engine/lacuna.hpp"

#include "tests/support/detected.hpp"
#include "tests/support/run_program.hpp"

#include <system_error>

namespace lacuna {
namespace {

Cloud punched_sheet() {
  return plane(50).punched({15, 14}, 5).punched({34, 33}, 7).jittered(0.3, 5).noisy(0.05, 6);
}

Config with_points() {
  Config config;
  config.results.points = true;
  return config;
}

std::string bytes_of(const Holes& holes) {
  return Detected{.summary = holes.summary, .points = holes.points, .boundary = {}, .loops = holes.loops}
      .bytes();
}

std::string bytes_without_boundary(Detected detected) {
  detected.boundary.clear();
  return detected.bytes();
}

TEST_CASE("points in memory, a source of batches and the streams of detect have the same holes",
          "[library]") {
  const Cloud cloud = punched_sheet().with_unusable(3, 7);
  const Holes in_memory = find_holes(cloud.positions, with_points());
  REQUIRE(in_memory.loops.size() == 3);
  CHECK(in_memory.points.size() == cloud.size());
  CHECK(in_memory.summary.counts.dropped == 3);

  MemoryScan batches(cloud, 77);
  CHECK(bytes_of(find_holes(batches, with_points())) == bytes_of(in_memory));
  CHECK(bytes_without_boundary(run_engine(cloud, tiled({}, 300))) == bytes_of(in_memory));
}

TEST_CASE("given normals that do not fit the surface are estimated, unless the user says otherwise",
          "[library]") {
  Cloud cloud = punched_sheet();
  cloud.normals.assign(cloud.size(), {0, 0, 1});
  const Holes right = find_holes(cloud.positions, cloud.normals, with_points());
  CHECK(right.summary.counts.normals_off == 0);
  cloud.normals.assign(cloud.size(), {1, 0, 0});
  const Holes wrong = find_holes(cloud.positions, cloud.normals, with_points());
  CHECK(wrong.summary.counts.normals_off == cloud.size());
  const std::string without = bytes_of(find_holes(cloud.positions, with_points()));
  CHECK(bytes_of(wrong) == without);
  for (std::size_t p = 0; p < cloud.size(); ++p) {
    const bool is_at_rim = (cloud.positions[p].head<2>() - Eigen::Vector2d(15, 14)).norm() < 7;
    cloud.normals[p] = is_at_rim ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(0, 0, 1);
  }
  const Holes at_rim = find_holes(cloud.positions, cloud.normals, with_points());
  CHECK(at_rim.loops.size() == 3);
  CHECK(at_rim.summary.counts.normals_off > 50);
  Config config = with_points();
  config.normals.use = NormalsUse::kEstimated;
  const Holes estimated = find_holes(cloud.positions, cloud.normals, config);
  CHECK(estimated.summary.counts.normals_off == 0);
  CHECK(bytes_of(estimated) == without);
  config.normals.use = NormalsUse::kGiven;
  CHECK(bytes_of(find_holes(cloud.positions, cloud.normals, config)) != without);
}

TEST_CASE("the library gives results of points only where they are wanted, and no loops of nothing",
          "[library]") {
  CHECK(find_holes(punched_sheet().positions).points.empty());
  const Holes none = find_holes(std::vector<Eigen::Vector3d>{}, with_points());
  CHECK(none.loops.empty());
  CHECK(none.points.empty());
  CHECK(find_holes(plane(1).positions, with_points()).points.size() == 1);
}

// Three floats of a record in another order, as other programs have them.
struct Measured {
  char before[5];
  float z = 0, y = 0, x = 0;
};

TEST_CASE("points of any type and stride are the same to the library", "[library]") {
  const Cloud cloud = punched_sheet();
  std::vector<Eigen::Vector3f> single;
  std::vector<Eigen::Vector3d> rounded;
  std::vector<Measured> records;
  for (const Eigen::Vector3d& p : cloud.positions) {
    single.push_back(p.cast<float>());
    rounded.push_back(single.back().cast<double>());
    records.push_back({{}, single.back().z(), single.back().y(), single.back().x()});
  }
  const std::string expected = bytes_of(find_holes(rounded, with_points()));
  CHECK(bytes_of(find_holes(single, with_points())) == expected);
  const PointArray strided(&records.front().x, records.size(), sizeof(Measured),
                           -std::ptrdiff_t{sizeof(float)});
  CHECK(bytes_of(find_holes(strided, with_points())) == expected);
  CHECK(bytes_of(find_holes(strided, strided, with_points())) ==
        bytes_of(find_holes(rounded, rounded, with_points())));
}

// Ends the run at its n-th call.
class Impatient final : public Progress {
 public:
  explicit Impatient(int calls) : calls_(calls) {}

  void begin(std::string_view, std::uint64_t) override { call(); }
  void advance(std::uint64_t) override { call(); }
  void end() noexcept override { ++ends; }
  int ends = 0;

 private:
  void call() {
    if (--calls_ <= 0) throw std::runtime_error("enough");
  }
  std::atomic<int> calls_;
};

TEST_CASE("an exception of the progress ends a run of the library, wherever it is", "[library]") {
  const Cloud cloud = punched_sheet();
  for (const int calls : {1, 2, 3, 5, 8, 13, 21}) {
    Impatient progress(calls);
    CHECK_THROWS_WITH(find_holes(cloud.positions, with_points(), &progress), "enough");
  }
  Impatient patient(1'000'000);
  CHECK(find_holes(cloud.positions, with_points(), &patient).loops.size() == 3);
  CHECK(patient.ends > 5);
}

// Notes the removed files that this process has open: the temporary files of a run.
class OpenFiles final : public Progress {
 public:
  OpenFiles() {
    begin("", 0);
    inherited_ = std::exchange(names, {});
  }
  void begin(std::string_view, std::uint64_t) override {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
      const std::string file = fs::read_symlink(entry.path(), error).string();
      if (file.ends_with(" (deleted)") && !inherited_.contains(file)) names.insert(file);
    }
  }
  void advance(std::uint64_t) override {}
  void end() noexcept override {}
  std::set<std::string> names;

 private:
  std::set<std::string> inherited_;  // such as the log of the program that runs the tests
};

TEST_CASE("the library's temporary files are in the wanted folder, and gone at the end", "[library]") {
  const ScratchFolder scratch;
  Config config;
  config.run.scratch = scratch.path().string();
  OpenFiles files;
  CHECK(find_holes(punched_sheet().positions, config, &files).loops.size() == 3);
  CHECK(files.names.size() > 3);
  for (const std::string& file : files.names) CHECK_THAT(file, StartsWith(scratch.path().string()));
  CHECK(test::count_entries(scratch.path()) == 0);
  config.run.scratch = (scratch / "missing").string();
  CHECK_THROWS_WITH(find_holes(punched_sheet().positions, config), Contains("missing"));
}

TEST_CASE("what the library cannot do is an error", "[library]") {
  const Cloud cloud = plane(5);
  CHECK_THROWS_WITH(find_holes(cloud.positions, std::span(cloud.positions).first(4)),
                    "4 normals for 25 points; allowed: one for each point");
  Cloud far = cloud;
  far.positions[7].x() = 1e200;
  CHECK_THROWS_WITH(find_holes(far.positions), Contains("point 7 lies at"));
  Config config;
  config.neighbourhood.eps = 1;
  config.neighbourhood.eps_fraction = 0.1;
  CHECK_THROWS_WITH(find_holes(cloud.positions, config), Contains("eps_fraction"));
}

}  // namespace
}  // namespace lacuna
