// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/coherence.hpp"

#include <numeric>
#include <vector>

namespace lacuna {
namespace {

// By row from the first candidate's on: the candidates that have it as a gap neighbour.
class Dependents {
 public:
  explicit Dependents(std::span<const Candidate> candidates)
      : first_(value(candidates.front().row)),
        begins_(value(candidates.back().row) - first_ + 2),
        candidates_(2 * candidates.size()) {
    for_each_gap(candidates, [&](std::size_t row, std::uint32_t) { ++begins_[row + 1]; });
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    std::vector<std::uint32_t> ends(begins_.begin(), begins_.end() - 1);
    for_each_gap(candidates, [&](std::size_t row, std::uint32_t i) { candidates_[ends[row]++] = i; });
  }

  std::span<const std::uint32_t> operator[](Row row) const {
    const std::size_t at = value(row) - first_;
    return std::span(candidates_).subspan(begins_[at], begins_[at + 1] - begins_[at]);
  }

 private:
  // Calls visit(row, candidate) for gap neighbours that lie among the candidates' rows.
  template <class Visit>
  void for_each_gap(std::span<const Candidate> candidates, Visit&& visit) const {
    for (std::uint32_t i = 0; i < candidates.size(); ++i) {
      for (const Row gap : {candidates[i].gap_near, candidates[i].gap_far}) {
        const std::uint64_t row = value(gap) - first_;  // large where it lies before the first
        if (row < begins_.size() - 1) visit(row, i);
      }
    }
  }

  std::uint64_t first_;
  std::vector<std::uint32_t> begins_;
  std::vector<std::uint32_t> candidates_;
};

}  // namespace

bool remove_incoherent(std::span<const Candidate> candidates, RowSet& boundary) {
  std::vector<std::uint32_t> removed;
  const auto check = [&](std::uint32_t i) {
    const Candidate& c = candidates[i];
    if (!boundary.contains(c.row)) return;
    if (boundary.contains(c.gap_near) && boundary.contains(c.gap_far)) return;
    boundary.erase(c.row);
    removed.push_back(i);
  };
  for (std::uint32_t i = 0; i < candidates.size(); ++i) check(i);
  if (removed.empty()) return false;
  const Dependents dependents(candidates);
  while (!removed.empty()) {
    const Row row = candidates[removed.back()].row;
    removed.pop_back();
    for (const std::uint32_t i : dependents[row]) check(i);
  }
  return true;
}

}  // namespace lacuna
