// SPDX-License-Identifier: Apache-2.0
// Outputs of tiles that several runs have sealed.
#include "engine/evaluate/kept_outputs.hpp"

#include "tests/support/scratch_folder.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

using test::ScratchFolder;

struct Kept {
  explicit Kept(const ScratchFolder& folder) : job(config, folder.path(), quiet) {
    job.kept = folder.path();
    tiling.tiles.resize(6);
    PartWriter(folder / "run").seal({});
  }

  // The outputs that are there; each is one number.
  std::map<TileIndex, std::uint64_t> numbers(const std::string& made_from) const {
    const KeptOutputs kept(3, tiling, made_from, "", check, job);
    std::map<TileIndex, std::uint64_t> numbers;
    std::mutex mutex;
    kept.for_each(job, [&](TileIndex tile, const TileOutput& output) {
      const std::lock_guard lock(mutex);
      CHECK(numbers.emplace(tile, output.read<std::uint64_t>("number").front()).second);
    });
    CHECK(kept.missing().size() == 6 - numbers.size());
    return numbers;
  }
  void add(const std::string& made_from, const std::map<TileIndex, std::uint64_t>& numbers) const {
    KeptOutputs kept(3, tiling, made_from, "", check, job);
    for (const auto& [tile, number] : numbers) {
      TileOutput output;
      output.add("number", std::vector{number});
      kept.add(tile, output);
    }
    kept.finish();
  }

  PartReader::Check check = PartReader::Check::kWhole;
  Tiling tiling;
  Config config;
  NoProgress quiet;
  Job job;
};

TEST_CASE("the outputs of several runs come together, each tile once") {
  const ScratchFolder folder;
  const Kept kept(folder);
  CHECK(kept.numbers("a").empty());
  kept.add("a", {{0, 10}, {4, 14}});
  kept.add("a", {{1, 11}, {4, 14}});  // as two processes may do
  kept.add("a", {{5, 15}});
  CHECK(kept.numbers("a") == std::map<TileIndex, std::uint64_t>{{0, 10}, {1, 11}, {4, 14}, {5, 15}});
  CHECK(folder.names().size() == 4);
}

TEST_CASE("outputs that are made from something else make room") {
  const ScratchFolder folder;
  const Kept kept(folder);
  kept.add("a", {{0, 10}});
  kept.add("a", {{1, 11}});
  kept.add("b", {{3, 23}});
  CHECK(kept.numbers("b") == std::map<TileIndex, std::uint64_t>{{3, 23}});
  CHECK(kept.numbers("a").empty());
  CHECK(folder.names() == std::vector<std::string>{"run"});
}

TEST_CASE("a unit takes no part away, and is content with the table of a part") {
  const ScratchFolder folder;
  Kept kept(folder);
  kept.add("a", {{0, 10}});
  kept.job.is_unit = true;
  kept.check = PartReader::Check::kTable;
  kept.add("b", {{1, 11}});
  CHECK(kept.numbers("a") == std::map<TileIndex, std::uint64_t>{{0, 10}});
  CHECK(kept.numbers("b") == std::map<TileIndex, std::uint64_t>{{1, 11}});
}

TEST_CASE("without a workspace no output is kept") {
  const ScratchFolder folder;
  Kept kept(folder);
  kept.job.kept.clear();
  kept.add("a", {{0, 10}});
  CHECK(kept.numbers("a").empty());
  CHECK(folder.names() == std::vector<std::string>{"run"});
}

}  // namespace
}  // namespace lacuna
