// SPDX-License-Identifier: Apache-2.0
// No result depends on how a run is cut up: all files at once, by whole processes.
#include "tests/support/json.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

// Every kind of result that needs no GDAL, but for the page: it shows the parameters.
const Words kAllResults = {"--points",         "--points-format", "ply",
                           "--points-normals", "--lids",          "--obj",
                           "--orient-normals", "--sample-points", "3000"};

void check_every_tiling(const std::string& scan, const fs::path& folder, const Words& options) {
  const auto detect = [&](const std::string& out, const Words& more) {
    return test::detect(scan, folder / out, with(with(kAllResults, options), more));
  };
  const fs::path one = detect("one", {"--tile-points", "1000000", "--threads", "1"});
  CHECK(read_json(one / "holes.json").at("loops").size() > 3);
  for (const char* name : {"points.ply", "lids.ply", "loops.obj"}) CHECK(fs::exists(one / name));
  for (const Words& more : {Words{"--tile-points", "500", "--threads", "8", "--memory-limit", "64MiB"},
                            {"--tile-points", "5000", "--threads", "2"},
                            {}}) {
    INFO(Catch::StringMaker<Words>::convert(more));
    check_same_results(detect("other", more), one);
  }
}

TEST_CASE("all results of a surface on Earth, with local coordinates, are the same for every tiling") {
  const ScratchFolder scratch;
  const std::string scan =
      synth("surface", scratch / "surface.ply",
            {"--points", "12000", "--holes", "4", "--hole-radius", "3", "6", "--density-step", "4", "--noise",
             "0.05", "--order", "random", "--double", "--translate", "500000.1", "5400000.7", "300.3"});
  check_every_tiling(scan, scratch.path(), {"--local-coordinates"});
}

TEST_CASE("all results of a scan with stations, and their causes, are the same for every tiling") {
  const ScratchFolder scratch;
  const std::string scan = synth("scan", scratch / "room.ply", {"--points", "15000", "--seed", "5"});
  check_every_tiling(scan, scratch.path(), {"--stations", (scratch / "room.stations.txt").string()});
}

}  // namespace
}  // namespace lacuna::test
