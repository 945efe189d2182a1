// SPDX-License-Identifier: Apache-2.0
// A run in the workspace of another one, whose input has changed, gives the result of a run from nothing.
#include "engine/consumers.hpp"
#include "engine/pipeline.hpp"
#include "engine/first_level.hpp"
#include "engine/pipeline_steps.hpp"
#include "engine/workspace/workspace.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/memory_scan.hpp"
#include "tests/support/scratch_folder.hpp"

#include <atomic>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using test::ScratchFolder;

// Points in the box take no part any more, and keep their ids.
void leave_out(Cloud& cloud, const Eigen::AlignedBox3d& box) {
  for (Eigen::Vector3d& p : cloud.positions) {
    if (box.contains(p)) p.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

void append(Cloud& cloud, const Cloud& added) {
  cloud.positions.insert(cloud.positions.end(), added.positions.begin(), added.positions.end());
  if (!cloud.normals.empty())
    cloud.normals.insert(cloud.normals.end(), added.positions.size(), Eigen::Vector3d::UnitZ());
}

Eigen::AlignedBox3d random_box(Random& random) {
  const Eigen::Vector3d middle(random.uniform(0, 60), random.uniform(0, 60), 0);
  const double half = random.uniform(0.5, 15);
  return {middle.array() - half, middle.array() + half};
}

// A denser patch, some of it on points of the cloud.
Cloud random_patch(Random& random, const Cloud& cloud) {
  const auto side = static_cast<int>(random.whole(2, 20));
  Cloud patch = plane(side).jittered(0.3, static_cast<std::uint64_t>(random.whole(1, 1000)));
  const Eigen::Vector3d corner(random.uniform(-20, 60), random.uniform(-20, 60), 0);
  for (Eigen::Vector3d& p : patch.positions) p = 0.7 * p + corner;
  for (int copies = 0; copies < 5; ++copies)
    patch.positions.push_back(
        cloud.positions[static_cast<std::size_t>(random.whole(0, std::int64_t(cloud.size()) - 1))]);
  return patch;
}

Cloud scan() {
  return plane(60).punched({18, 20}, 5).jittered(0.3, 5).with_duplicates(200, 1).with_outliers(3, 2, 1);
}

Config small_tiles(const fs::path& workspace) {
  Config config;
  config.run.tile_points = 150;
  config.run.threads = 2;
  config.run.workspace = workspace.string();
  return config;
}

std::string bytes_from_nothing(const Cloud& cloud, Config config) {
  config.run.workspace.clear();
  return run_engine(cloud, config).bytes();
}

TEST_CASE("an updated run gives the result of a run from nothing, again and again") {
  Random random(11);
  for (int variant = 0; variant < 5; ++variant) {
    const ScratchFolder folder;
    Config config = small_tiles(folder.path());
    Cloud cloud = scan();
    if (variant == 1) config.loops.method = LoopMethod::kPaper;
    if (variant == 2) config.normals.orient = config.results.voxels = true;
    if (variant == 3) config.scale.min_hole = 8;
    if (variant == 4) cloud = cloud.with_random_normals(2);
    CHECK(run_engine(cloud, config).bytes() == bytes_from_nothing(cloud, config));
    for (int round = 0; round < 6; ++round) {
      const std::int64_t what = random.whole(0, 2);
      if (what != 0) leave_out(cloud, random_box(random));
      if (what != 1) append(cloud, random_patch(random, cloud));
      INFO("variant " << variant << ", round " << round);
      begin_update(folder.path());
      if (random.whole(0, 3) == 0) config.run.threads = static_cast<std::int64_t>(random.whole(1, 4));
      CHECK(run_engine(cloud, config).bytes() == bytes_from_nothing(cloud, config));
      // One that was stopped right before its end goes on.
      if (random.whole(0, 2) == 0)
        CHECK(run_engine(cloud, config).bytes() == bytes_from_nothing(cloud, config));
      end_update(folder.path());
      CHECK_FALSE(fs::exists(earlier_run(folder.path())));
    }
  }
}

TEST_CASE("an update that was stopped while it moved the data of the run begins again") {
  const ScratchFolder folder;
  const Config config = small_tiles(folder.path());
  Cloud cloud = scan();
  run_engine(cloud, config);
  write_note(folder.path(), WorkspaceNote::kResults, "results");
  for (const fs::path& part : workspace_files(folder.path()))
    if (level_of_part(part)) remove_part(part);
  fs::create_directory(earlier_run(folder.path()));
  fs::rename(folder / "results", earlier_run(folder.path()) / "results");
  begin_update(folder.path());
  CHECK(workspace_files(earlier_run(folder.path())).size() == 2);
  CHECK(read_note(earlier_run(folder.path()), WorkspaceNote::kResults) == "results");
  CHECK(workspace_files(folder.path()).empty());
  leave_out(cloud, {Eigen::Vector3d(10, 10, -1), Eigen::Vector3d(14, 12, 1)});
  CHECK(run_engine(cloud, config).bytes() == bytes_from_nothing(cloud, config));
}

}  // namespace
}  // namespace lacuna
