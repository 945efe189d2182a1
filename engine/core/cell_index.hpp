// From a place to the cell that holds it: an OpenVDB grid of cell numbers.
#pragma once

#include "engine/data/tiling.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>

namespace lacuna {

class CellIndex {
 public:
  explicit CellIndex(const Tiling& tiling);
  ~CellIndex();

  // Remembers where it was last: near look-ups are fast. One per thread.
  class Reader {
   public:
    explicit Reader(const CellIndex& index);
    ~Reader();
    std::uint32_t cell_of(const Eigen::Vector3d& position);  // which must be in a counted cell

   private:
    struct Access;
    std::unique_ptr<Access> access_;
  };

  // Writes grids `points` and `tile` over the cells, for OpenVDB's own tools.
  static void save(const Tiling& tiling, const std::filesystem::path& file);

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

}  // namespace lacuna
