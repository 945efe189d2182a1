// SPDX-License-Identifier: Apache-2.0
// sampled_surface: where the surfaces of a scene are sampled, on a lattice.
//
// Idea: surfaces are cut into rectangular patches, each with a lattice of nodes. A node is sampled if a
// station sees it. A gap counts as sampled, too, if no ball without a sampled place fits into it.
//
// Cost: a ray for each node and sweep.
#pragma once

#include "bench/synth/arithmetic.hpp"
#include "bench/synth/scanner.hpp"
#include "bench/synth/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace lacuna::synth {

// Places and unit normals are functions of u and v, both in [0, 1]. Patches of one shape share their edges.
struct Patch {
  std::uint32_t shape;   // Hit::shape
  bool two_sided;        // else the normal points out of the shape
  double width, height;  // metres along u and v, about
  std::function<Vec3(double, double)> place;
  std::function<Vec3(double, double)> normal;
};

// Returns the patches of all shapes that return light; black shapes have no patch. Flat patches end a tenth
// of a millimetre before their edges, where two shapes that touch would hide each other.
std::vector<Patch> patches_of(const Scene& scene);

struct Sphere {
  Vec3 centre;
  double radius;  // above 0
};

// Spheres of similar radius share a lattice of cells no smaller than the spheres. A place that no sphere is
// near costs one bit per lattice.
class SphereIndex {
 public:
  explicit SphereIndex(std::vector<Sphere> spheres);

  // Calls `use(number)` for each sphere that holds the place, in no useful order.
  template <typename Use>
  void for_each_around(Vec3 place, const Use& use) const {
    for (const Level& level : levels_) {
      const std::uint64_t key =
          key_of(level, cell(place.x, level), cell(place.y, level), cell(place.z, level));
      if (!present_[key & mask_]) continue;
      auto entry = std::lower_bound(entries_.begin(), entries_.end(), std::pair(key, std::uint32_t{0}));
      for (; entry != entries_.end() && entry->first == key; ++entry) {
        const Sphere& sphere = spheres_[entry->second];
        const Vec3 arm = place - sphere.centre;
        if (dot(arm, arm) <= sphere.radius * sphere.radius) use(entry->second);
      }
    }
  }

  const std::vector<Sphere>& spheres() const { return spheres_; }

 private:
  // Cells are a power of two wide.
  struct Level {
    int exponent;
    double cells_per_metre;

    friend auto operator<=>(const Level&, const Level&) = default;
  };
  static std::int64_t cell(double coordinate, const Level& level) {
    return static_cast<std::int64_t>(std::floor(coordinate * level.cells_per_metre));
  }
  static std::uint64_t key_of(const Level& level, std::int64_t x, std::int64_t y, std::int64_t z) {
    std::uint64_t key = mix(static_cast<std::uint64_t>(level.exponent) + 1);
    for (const std::int64_t axis : {x, y, z}) key = mix(key + static_cast<std::uint64_t>(axis) * 3);
    return key;
  }

  std::vector<Sphere> spheres_;
  std::vector<Level> levels_;                                     // ascending
  std::vector<std::pair<std::uint64_t, std::uint32_t>> entries_;  // cell and sphere, ascending
  std::vector<bool> present_;                                     // keys modulo its size
  std::uint64_t mask_ = 0;
};

// The nodes of one patch. Nodes outside of it are valid arguments, and are not sampled.
struct Lattice {
  Patch patch;
  std::int32_t columns, rows;         // nodes, along u and v
  double step;                        // metres, the larger of both directions
  std::vector<float> spacing;         // of the points around each node; 0 if no station samples it
  std::vector<std::uint8_t> sampled;  // by a station, or in a gap too narrow for a hole
  std::vector<bool> by_station;       // is the node sampled: station after station of each node

  std::size_t node(std::int32_t column, std::int32_t row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  bool inside(std::int32_t column, std::int32_t row) const {
    return column >= 0 && column < columns && row >= 0 && row < rows;
  }
  bool is_sampled(std::int32_t column, std::int32_t row) const {
    return inside(column, row) && sampled[node(column, row)] != 0;
  }
  double u(double column) const { return column / (columns - 1); }
  double v(double row) const { return row / (rows - 1); }
  // Places between the nodes are valid, too.
  ScenePoint at(double column, double row) const {
    return {patch.place(u(column), v(row)), patch.normal(u(column), v(row)), patch.shape, patch.two_sided};
  }
};

// The lattice has about 4 nodes per point, but at most 3 million, and fewer for more than 4 sweeps.
std::vector<Lattice> sample_surfaces(const Scanner& scanner, const Visibility& visibility,
                                     std::uint64_t points);

// A place that no station samples counts as sampled all the same unless it lies in a hole. Holes are balls
// with this radius, in spacings of the nearest sampled places, in which nothing is sampled. Every place
// within 1.5 radii of the middle of a ball belongs to its hole. Places on the far side of a thin thing are
// not near.
void close_gaps(std::vector<Lattice>& lattices, const Visibility& visibility, double hole_radius);

}  // namespace lacuna::synth
