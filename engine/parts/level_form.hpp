// SPDX-License-Identifier: Apache-2.0
// A level, or a task's share of its tiles, as a part: its store, and all else that the steps behind it need.
// Its points and normals are columns, files of their own, which are written in place.
#pragma once

#include "engine/config/job.hpp"
#include "engine/parts/parts.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/thin/level.hpp"

#include <optional>
#include <string>
#include <vector>

namespace lacuna {

struct LevelForm {
  const Parts& parts;
  const Job& job;
  std::string step;  // "level-0"

  // Returns nothing where a column is not there, or where a tile does not fit in memory.
  std::optional<Level> read(const PartReader& part) const;
  // Seals the columns, too.
  void write(Level& level, PartWriter& part) const;
  // Returns empty files for the store of a level that is to be kept, or of any other.
  StoreFiles files() const;
};

// Returns empty files for a store that is not kept.
StoreFiles temporary_store(const Spill& spill);

// Joins the shares of a level, one or more, in order.
Level join_levels(std::vector<Level> shares, const Spill& spill);

}  // namespace lacuna
