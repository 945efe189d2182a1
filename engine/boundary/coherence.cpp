#include "engine/boundary/coherence.hpp"

#include <algorithm>

namespace lacuna {
namespace {

// The candidates that lean on each candidate: (whom, who), sorted.
struct Leaning {
  std::uint32_t on, who;
};

std::vector<Leaning> who_leans_on_whom(std::span<const Candidate> candidates) {
  std::vector<Leaning> leaning;
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    for (const Row gap : {candidates[i].gap_near, candidates[i].gap_far}) {
      const auto at = std::lower_bound(candidates.begin(), candidates.end(), gap,
                                       [](const Candidate& c, Row row) { return c.row < row; });
      if (at != candidates.end() && at->row == gap) {
        leaning.push_back({static_cast<std::uint32_t>(at - candidates.begin()), i});
      }
    }
  }
  std::sort(leaning.begin(), leaning.end(), [](const Leaning& a, const Leaning& b) { return a.on < b.on; });
  return leaning;
}

}  // namespace

bool remove_incoherent(std::span<const Candidate> candidates, RowSet& boundary) {
  std::vector<std::uint32_t> fallen;
  const auto look_at = [&](std::uint32_t i) {
    const Candidate& c = candidates[i];
    if (!boundary.contains(c.row)) return;
    if (boundary.contains(c.gap_near) && boundary.contains(c.gap_far)) return;
    boundary.erase(c.row);
    fallen.push_back(i);
  };
  for (std::uint32_t i = 0; i < candidates.size(); ++i) look_at(i);
  if (fallen.empty()) return false;
  const std::vector<Leaning> leaning = who_leans_on_whom(candidates);
  while (!fallen.empty()) {
    const std::uint32_t gone = fallen.back();
    fallen.pop_back();
    auto at = std::lower_bound(leaning.begin(), leaning.end(), gone,
                               [](const Leaning& a, std::uint32_t on) { return a.on < on; });
    for (; at != leaning.end() && at->on == gone; ++at) look_at(at->who);
  }
  return true;
}

}  // namespace lacuna
