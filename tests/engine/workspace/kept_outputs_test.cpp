// SPDX-License-Identifier: Apache-2.0
// Outputs of tiles that several runs have sealed.
#include "engine/workspace/kept_outputs.hpp"

#include "tests/support/scratch_folder.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

using test::ScratchFolder;

constexpr std::size_t kTiles = 6;

struct Kept {
  explicit Kept(const ScratchFolder& folder) : workspace{.folder = folder.path()} {
    PartWriter(folder / "run").seal({});
  }

  KeptOutputs open(const std::string& made_from) const {
    return KeptOutputs(3, kTiles, made_from, workspace);
  }
  // The outputs that are there; each is one number.
  std::map<TileIndex, std::uint64_t> numbers(const std::string& made_from) const {
    const KeptOutputs kept = open(made_from);
    std::vector<TileIndex> missing = kept.missing();
    std::map<TileIndex, std::uint64_t> numbers;
    for (TileIndex tile = 0; tile < kTiles; ++tile) {
      if (std::find(missing.begin(), missing.end(), tile) != missing.end()) continue;
      REQUIRE(kept.size("number", tile) == sizeof(std::uint64_t));
      CHECK(kept.size("other", tile) == 0);
      kept.read("number", tile, std::as_writable_bytes(std::span(&numbers[tile], 1)));
    }
    return numbers;
  }
  // Those that are added are there at once, too.
  void add(const std::string& made_from, const std::map<TileIndex, std::uint64_t>& numbers) const {
    KeptOutputs kept = open(made_from);
    for (const auto& [tile, number] : numbers) {
      const KeptOutputs::Stream stream{"number", std::as_bytes(std::span(&number, 1))};
      kept.add(tile, {&stream, 1});
    }
    kept.finish();
    for (const auto& [tile, number] : numbers) {
      std::uint64_t read = 0;
      kept.read("number", tile, std::as_writable_bytes(std::span(&read, 1)));
      CHECK(read == number);
    }
  }

  Workspace workspace;
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

TEST_CASE("a unit takes no part away") {
  const ScratchFolder folder;
  Kept kept(folder);
  kept.add("a", {{0, 10}});
  kept.workspace.is_unit = true;
  kept.add("b", {{1, 11}});
  CHECK(kept.numbers("a") == std::map<TileIndex, std::uint64_t>{{0, 10}});
  CHECK(kept.numbers("b") == std::map<TileIndex, std::uint64_t>{{1, 11}});
}

}  // namespace
}  // namespace lacuna
