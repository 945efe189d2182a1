// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/truth_loops.hpp"

#include <algorithm>
#include <utility>

namespace lacuna::synth {

TruthLoops::TruthLoops(std::vector<NumberLoop> loops, std::size_t holes)
    : loops_(std::move(loops)), holes_(holes) {
  for (const NumberLoop& loop : loops_) numbers_.insert(numbers_.end(), loop.begin(), loop.end());
  std::sort(numbers_.begin(), numbers_.end());
  numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
  ids_.resize(numbers_.size());
}

void TruthLoops::note(std::uint64_t number, std::uint64_t id) {
  const auto found = std::lower_bound(numbers_.begin(), numbers_.end(), number);
  if (found != numbers_.end() && *found == number)
    ids_[static_cast<std::size_t>(found - numbers_.begin())] = id;
}

std::vector<TruthLoops::IdLoop> TruthLoops::in_ids() const {
  std::vector<IdLoop> all;
  all.reserve(loops_.size());
  for (const NumberLoop& loop : loops_) {
    std::vector<std::uint64_t> ids;
    ids.reserve(loop.size());
    for (const std::uint64_t number : loop) {
      const auto found = std::lower_bound(numbers_.begin(), numbers_.end(), number);
      ids.push_back(ids_[static_cast<std::size_t>(found - numbers_.begin())]);
    }
    std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
    if (ids.back() < ids[1]) std::reverse(ids.begin() + 1, ids.end());
    all.push_back({std::move(ids), all.size() < holes_});
  }
  std::sort(all.begin(), all.end(), [](const IdLoop& a, const IdLoop& b) { return a.ids < b.ids; });
  return all;
}

}  // namespace lacuna::synth
