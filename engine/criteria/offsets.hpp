// A point's neighbours as offsets q - p, nearest first.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// One array per coordinate, so that arithmetic runs over whole neighbourhoods.
struct Offsets {
  std::vector<double> x, y, z;
  std::vector<double> squared_distance;  // (x x + y y) + z z
  std::vector<double> distance;

  std::size_t size() const { return x.size(); }
  Eigen::Vector3d operator[](std::size_t rank) const { return {x[rank], y[rank], z[rank]}; }

  void resize(std::size_t count) {
    for (auto* column : {&x, &y, &z, &squared_distance, &distance}) column->resize(count);
  }
  void set(std::size_t rank, const Eigen::Vector3d& offset) {
    x[rank] = offset.x();
    y[rank] = offset.y();
    z[rank] = offset.z();
    squared_distance[rank] = (x[rank] * x[rank] + y[rank] * y[rank]) + z[rank] * z[rank];
    distance[rank] = std::sqrt(squared_distance[rank]);
  }
};

}  // namespace lacuna
