// SPDX-License-Identifier: Apache-2.0
// Disjoint sets over [0, n). Union is by index, so a set's root is its smallest element.
#pragma once

#include "engine/model/ids.hpp"

#include <span>
#include <utility>

namespace lacuna {

// The sets are in memory of the caller's, one zero per element. Cost: near constant per call (path halving).
class UnionFind {
 public:
  explicit UnionFind(std::span<LocalIndex> links) : links_(links) {}

  LocalIndex find(LocalIndex x) {
    while (!is_root(x)) {
      const LocalIndex up = parent(x);
      if (!is_root(up)) links_[x] = links_[up];
      x = up;
    }
    return x;
  }

  // Returns false if they were one set already.
  bool unite(LocalIndex a, LocalIndex b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    if (a > b) std::swap(a, b);
    links_[b] = a + 1;
    return true;
  }

 private:
  bool is_root(LocalIndex x) const { return links_[x] == 0; }
  LocalIndex parent(LocalIndex x) const { return links_[x] - 1; }

  std::span<LocalIndex> links_;  // parent + 1; 0: a root, so that memory fresh from the system will do
};

}  // namespace lacuna
