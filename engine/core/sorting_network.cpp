#include "engine/core/sorting_network.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <memory>
#include <mutex>
#include <vector>

namespace lacuna {
namespace {

using Network = std::vector<Comparison>;

Network merge_exchange(std::size_t rows) {
  Network network;
  for (std::size_t p = std::bit_ceil(rows) / 2; p > 0; p /= 2) {
    std::size_t q = std::bit_ceil(rows) / 2, r = 0, d = p;
    for (;;) {
      for (std::size_t i = 0; i + d < rows; ++i) {
        if ((i & p) == r) network.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i + d)});
      }
      if (q == p) break;
      d = q - p;
      q /= 2;
      r = p;
    }
  }
  return network;
}

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
    owned.push_back(std::make_unique<const Network>(needed_for(merge_exchange(rows), wanted)));
    network = owned.back().get();
    place.store(network, std::memory_order_release);
  }
  return {network->data(), network->size()};
}

}  // namespace lacuna
