// A point's neighbours as offsets q - p, nearest first.
#pragma once

#include "engine/core/vector_math.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// One array per coordinate, in whole lanes (core/vector_math), so that arithmetic runs over whole
// neighbourhoods.
struct Offsets {
  std::vector<double> x, y, z;
  std::vector<double> squared_distance;  // (x x + y y) + z z
  std::vector<double> distance;

  std::size_t size() const { return count_; }
  Eigen::Vector3d operator[](std::size_t rank) const { return {x[rank], y[rank], z[rank]}; }

  // The columns only ever grow: this is done for every point.
  void resize(std::size_t count) {
    count_ = count;
    if (count <= x.size()) return;
    for (auto* column : {&x, &y, &z, &squared_distance, &distance}) column->resize(lanes(count));
  }
  void set(std::size_t rank, const Eigen::Vector3d& offset) {
    x[rank] = offset.x();
    y[rank] = offset.y();
    z[rank] = offset.z();
    squared_distance[rank] = (x[rank] * x[rank] + y[rank] * y[rank]) + z[rank] * z[rank];
    distance[rank] = std::sqrt(squared_distance[rank]);
  }

 private:
  std::size_t count_ = 0;
};

}  // namespace lacuna
