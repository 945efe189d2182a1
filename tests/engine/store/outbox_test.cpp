// SPDX-License-Identifier: Apache-2.0
#include "engine/store/outbox.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/scratch_folder.hpp"

#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

using test::ScratchFolder;

TEST_CASE("every record arrives at its tile in the order in which it was added, and few are held back") {
  const ScratchFolder folder;
  AppendLists<std::uint32_t> lists(folder / "lists", 3, std::make_shared<BufferPool>(1 << 20));
  std::vector<std::vector<std::uint32_t>> wanted(3);
  Outbox<std::uint32_t> outbox(lists);
  Random random(1);
  for (std::uint32_t record = 0; record < 50'000; ++record) {
    const auto to = static_cast<TileIndex>(random.uniform(0, 2));  // none for the last tile
    wanted[to].push_back(record);
    outbox.add(to, record);
  }
  CHECK(lists.count(0) + lists.count(1) == 3 * 16'384);
  outbox.send();
  outbox.send();  // there is nothing left
  for (TileIndex to = 0; to < 3; ++to) CHECK(lists.read(to) == wanted[to]);
}

}  // namespace
}  // namespace lacuna
