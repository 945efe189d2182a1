// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/coherence.hpp"

#include "tests/support/clouds.hpp"

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

Candidate leaning(std::uint64_t row, std::uint64_t near, std::uint64_t far) {
  return {Row{row}, Row{near}, Row{far}};
}

RowSet all_of(const std::vector<Candidate>& candidates, std::uint64_t rows) {
  RowSet set(rows);
  for (const Candidate& c : candidates) set.insert(c.row);
  return set;
}

std::vector<std::uint64_t> rows_in(const RowSet& set, std::uint64_t rows) {
  std::vector<std::uint64_t> in;
  for (std::uint64_t row = 0; row < rows; ++row) {
    if (set.contains(Row{row})) in.push_back(row);
  }
  return in;
}

std::vector<std::uint64_t> plainly(const std::vector<Candidate>& candidates, std::uint64_t rows) {
  RowSet set = all_of(candidates, rows);
  for (bool changed = true; changed;) {
    changed = false;
    for (const Candidate& c : candidates) {
      if (!set.contains(c.row) || (set.contains(c.gap_near) && set.contains(c.gap_far))) continue;
      set.erase(c.row);
      changed = true;
    }
  }
  return rows_in(set, rows);
}

TEST_CASE("only the candidates' own bits are changed") {
  RowSet boundary(10);
  boundary.insert(Row{7});
  const std::vector<Candidate> one{leaning(2, 7, 3)};
  boundary.insert(Row{2});
  CHECK(remove_incoherent(one, boundary));
  CHECK(rows_in(boundary, 10) == std::vector<std::uint64_t>{7});
}

TEST_CASE("parts of a scan in any order, repeated until nothing changes, give the greatest fixed point") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const std::uint64_t rows = 1 + std::uint64_t(random.whole(0, 300));
    std::vector<Candidate> candidates;
    for (std::uint64_t row = 0; row < rows; ++row) {
      if (!random.chance(0.95)) continue;
      const auto other = [&] {
        const std::int64_t at = std::int64_t(row) + random.whole(-4, 4);
        return std::uint64_t((at + std::int64_t(rows)) % std::int64_t(rows));
      };
      candidates.push_back(leaning(row, random.chance(0.9) ? row : other(), other()));
    }
    const std::vector<std::uint64_t> expected = plainly(candidates, rows);
    RowSet whole = all_of(candidates, rows);
    remove_incoherent(candidates, whole);
    CHECK(rows_in(whole, rows) == expected);

    const std::size_t cut = candidates.size() / 3;
    const std::span<const Candidate> all = candidates;
    for (const bool first_first : {true, false}) {
      RowSet set = all_of(candidates, rows);
      for (bool changed = true; changed;) {
        const bool one = remove_incoherent(first_first ? all.first(cut) : all.subspan(cut), set);
        const bool other = remove_incoherent(first_first ? all.subspan(cut) : all.first(cut), set);
        changed = one || other;
      }
      CHECK(rows_in(set, rows) == expected);
    }
  }
}

}  // namespace
}  // namespace lacuna
