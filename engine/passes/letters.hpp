// Records on their way to other tiles.
#pragma once

#include "engine/core/spill.hpp"
#include "engine/data/tiling.hpp"

#include <vector>

namespace lacuna {

// Gathers records by the tile that they are for: a list takes few long runs better than many short ones. Not
// from several threads at once; several may write to the same lists.
template <class Record>
class Letters {
 public:
  explicit Letters(Spill<Record>& lists) : lists_(lists), letters_(lists.lists()) {}

  // Sends a letter that is full.
  void add(TileIndex to, const Record& record) {
    constexpr std::size_t kFull = 1024;
    letters_[to].push_back(record);
    if (letters_[to].size() == kFull) send(to);
  }

  // Sends the rest.
  void send() {
    for (TileIndex to = 0; to < letters_.size(); ++to) send(to);
  }

 private:
  void send(TileIndex to) {
    lists_.append(to, letters_[to]);
    letters_[to].clear();
  }

  Spill<Record>& lists_;
  std::vector<std::vector<Record>> letters_;
};

}  // namespace lacuna
