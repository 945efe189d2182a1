// SPDX-License-Identifier: Apache-2.0
#include "io/results/row_lists.hpp"

#include "tests/support/scratch_folder.hpp"

#include <algorithm>
#include <random>
#include <string>

#include <catch2/catch.hpp>

namespace lacuna::io {

TEST_CASE("each list has its bytes in the order in which they were put, and the file has no name", "[io]") {
  const test::ScratchFolder folder;
  for (const std::size_t block : {9u, 16u, 100u}) {
    std::mt19937 random(1);
    RowLists lists(folder / "rows", 7, block);
    CHECK(folder.names().empty());
    std::vector<std::string> expected(7);
    for (int i = 0; i < 500; ++i) {
      const std::size_t list = random() % 6;  // the last one stays empty
      const std::string bytes(random() % 30, static_cast<char>(random()));
      expected[list] += bytes;
      lists.append(list, std::as_bytes(std::span(bytes)));
    }
    for (std::size_t list = 0; list < expected.size(); ++list) {
      std::string read;
      lists.read(list, [&](std::span<const std::byte> bytes) {
        read.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      });
      CHECK(lists.size(list) == expected[list].size());
      CHECK((read == expected[list]));
    }
  }
}

}  // namespace lacuna::io
