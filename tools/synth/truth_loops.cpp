#include "tools/synth/truth_loops.hpp"

#include <algorithm>
#include <cassert>

namespace lacuna::synth {

TruthLoops::TruthLoops(std::vector<NodeLoop> loops) : loops_(std::move(loops)) {
  for (const NodeLoop& loop : loops_) nodes_.insert(nodes_.end(), loop.begin(), loop.end());
  std::sort(nodes_.begin(), nodes_.end());
  assert(std::adjacent_find(nodes_.begin(), nodes_.end()) == nodes_.end());
  ids_.resize(nodes_.size());
}

std::size_t TruthLoops::place(std::uint64_t node) const {
  const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), node);
  assert(found != nodes_.end() && *found == node);
  return static_cast<std::size_t>(found - nodes_.begin());
}

void TruthLoops::note(std::uint64_t node, std::uint64_t id) {
  ids_[place(node)] = id;
}

std::vector<std::vector<std::uint64_t>> TruthLoops::in_ids() const {
  std::vector<std::vector<std::uint64_t>> all;
  all.reserve(loops_.size());
  for (const NodeLoop& loop : loops_) {
    std::vector<std::uint64_t> ids;
    ids.reserve(loop.size());
    for (const std::uint64_t node : loop) ids.push_back(ids_[place(node)]);
    std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
    if (ids.back() < ids[1]) std::reverse(ids.begin() + 1, ids.end());
    all.push_back(std::move(ids));
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace lacuna::synth
