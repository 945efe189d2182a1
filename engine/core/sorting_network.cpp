#include "engine/core/sorting_network.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace lacuna {
namespace {

using Network = std::vector<Comparison>;

// Backwards from the wanted rows: a comparison that touches none that is needed is left out.
Network needed_for(const Network& network, std::size_t wanted) {
  std::array<bool, kMostSortedRows> needed{};
  std::fill_n(needed.begin(), wanted, true);
  Network kept;
  for (auto c = network.rbegin(); c != network.rend(); ++c) {
    if (!needed[c->low] && !needed[c->high]) continue;
    needed[c->low] = needed[c->high] = true;
    kept.push_back(*c);
  }
  std::reverse(kept.begin(), kept.end());
  return kept;
}

}  // namespace

SortingNetwork sorting_network(std::size_t rows, std::size_t wanted) {
  static std::array<std::array<std::atomic<const Network*>, kMostSortedRows + 1>, kMostSortedRows + 1>
      networks;
  static std::mutex mutex;
  static std::vector<std::unique_ptr<const Network>> owned;
  wanted = std::min(wanted, rows);
  std::atomic<const Network*>& place = networks[rows][wanted];
  const Network* network = place.load(std::memory_order_acquire);
  if (network == nullptr) {
    const std::lock_guard lock(mutex);
    Network all;
    for_each_comparison(rows, [&](Comparison c) { all.push_back(c); });
    owned.push_back(std::make_unique<const Network>(needed_for(all, wanted)));
    network = owned.back().get();
    place.store(network, std::memory_order_release);
  }
  return {network->data(), network->size()};
}

}  // namespace lacuna
