// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/sampled_surface.hpp"

#include "bench/synth/sphere_index.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace lacuna::synth {

namespace {

constexpr double kNodesPerPoint = 4;
constexpr double kMostNodes = 3e6;
constexpr double kMostRays = 1.2e7;   // one per node and sweep
constexpr double kFewestNodes = 3e5;  // where there are so many points
constexpr double kFewestSteps = 6;    // along each side of a patch
constexpr double kHoleCorner = 1.5;   // of the radius: the corner of a square hole is in the hole
constexpr double kFarSide = -0.5;     // cosine between normals: of the two sides of one thing
constexpr std::array<std::pair<int, int>, 4> kBeside{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

Lattice lay_lattice(const Patch& patch, double step) {
  const auto nodes = [&](double length) {
    return static_cast<std::int32_t>(std::max(std::ceil(length / step), kFewestSteps)) + 1;
  };
  Lattice lattice{.patch = patch, .columns = nodes(patch.width), .rows = nodes(patch.height)};
  lattice.step = std::max(patch.width / (lattice.columns - 1), patch.height / (lattice.rows - 1));
  return lattice;
}

template <typename Use>
void for_each_node(const Lattice& lattice, const Use& use) {
  for (std::int32_t row = 0; row < lattice.rows; ++row)
    for (std::int32_t column = 0; column < lattice.columns; ++column)
      use(column, row, lattice.node(column, row));
}

// Whether the node has a neighbour that fails the test, or lacks one.
template <typename Holds>
bool is_border(const Lattice& lattice, std::int32_t column, std::int32_t row, const Holds& holds) {
  return std::any_of(kBeside.begin(), kBeside.end(), [&](const auto& beside) {
    const std::int32_t next_column = column + beside.first, next_row = row + beside.second;
    return !lattice.inside(next_column, next_row) || !holds(lattice.node(next_column, next_row));
  });
}

// The places where sampling ends, each with the radius within which no hole is.
struct SampledBorder {
  std::vector<Sphere> spheres;
  std::vector<ScenePoint> places;
};

// Returns the side of a two-sided patch on which the first station that samples it lies.
ScenePoint with_side(ScenePoint place, const Visibility& visibility) {
  if (!place.two_sided) return place;
  if (const std::optional<Vec3> normal = visibility.facing(place)) {
    place.normal = *normal;
    place.two_sided = false;
  }
  return place;
}

SampledBorder border_of(const std::vector<Lattice>& lattices, const Visibility& visibility,
                        double hole_radius) {
  SampledBorder border;
  for (const Lattice& lattice : lattices) {
    const auto holds = [&](std::size_t node) { return lattice.spacing[node] > 0; };
    for_each_node(lattice, [&](std::int32_t column, std::int32_t row, std::size_t node) {
      if (!holds(node) || !is_border(lattice, column, row, holds)) return;
      border.places.push_back(with_side(lattice.at(column, row), visibility));
      border.spheres.push_back({border.places.back().position, hole_radius * double{lattice.spacing[node]}});
    });
  }
  return border;
}

bool on_one_side(const ScenePoint& a, const ScenePoint& b) {
  return a.two_sided || b.two_sided || dot(a.normal, b.normal) > kFarSide;
}

// Returns the smallest radius of the spheres around each node that is not sampled; 0 at the cores of holes.
std::vector<std::vector<float>> radii_around(const std::vector<Lattice>& lattices, SampledBorder border) {
  const std::vector<ScenePoint> places = std::move(border.places);
  const SphereIndex index(std::move(border.spheres));
  std::vector<std::vector<float>> radii;
  for (const Lattice& lattice : lattices) {
    std::vector<float>& own = radii.emplace_back(lattice.sampled.size());
    for_each_node(lattice, [&](std::int32_t column, std::int32_t row, std::size_t node) {
      if (lattice.spacing[node] > 0) return;
      const ScenePoint place = lattice.at(column, row);
      index.for_each_around(place.position, [&](std::uint32_t number) {
        if (!on_one_side(place, places[number])) return;
        const auto radius = static_cast<float>(index.spheres()[number].radius);
        own[node] = own[node] == 0 ? radius : std::min(own[node], radius);
      });
    });
  }
  return radii;
}

// Adds the parts of holes that the cores do not reach, around the outermost nodes of the cores.
SphereIndex rounds_of(const std::vector<Lattice>& lattices, const std::vector<std::vector<float>>& radii) {
  std::vector<Sphere> rounds;
  for (std::size_t i = 0; i < lattices.size(); ++i) {
    const Lattice& lattice = lattices[i];
    const std::vector<float>& around = radii[i];
    for_each_node(lattice, [&](std::int32_t column, std::int32_t row, std::size_t node) {
      if (lattice.spacing[node] > 0 || around[node] > 0) return;
      float radius = 0;
      for (const auto& [right, up] : kBeside)
        if (lattice.inside(column + right, row + up))
          radius = std::max(radius, around[lattice.node(column + right, row + up)]);
      if (radius > 0)
        rounds.push_back({lattice.at(column, row).position, kHoleCorner * (double{radius} + lattice.step)});
    });
  }
  return SphereIndex(std::move(rounds));
}

}  // namespace

std::vector<Lattice> sample_surfaces(const Scanner& scanner, const Visibility& visibility,
                                     std::uint64_t points) {
  const std::vector<Patch> patches = patches_of(scanner.scene());
  double area = 0;
  for (const Patch& patch : patches) area += patch.width * patch.height;
  const double affordable =
      std::max(kMostRays / static_cast<double>(visibility.sweeps().size()), kFewestNodes);
  const double nodes = std::min({kNodesPerPoint * static_cast<double>(points), kMostNodes, affordable});
  const double step = std::sqrt(area / nodes);
  std::vector<Lattice> lattices;
  for (const Patch& patch : patches) {
    Lattice& lattice = lattices.emplace_back(lay_lattice(patch, step));
    const std::size_t size =
        static_cast<std::size_t>(lattice.columns) * static_cast<std::size_t>(lattice.rows);
    lattice.spacing.resize(size);
    lattice.sampled.resize(size);
    lattice.by_station.resize(size * scanner.stations().size());
    for_each_node(lattice, [&](std::int32_t column, std::int32_t row, std::size_t node) {
      const ScenePoint place = lattice.at(column, row);
      double sum = 0;
      for (const std::uint32_t sweep : visibility.sweeps()) {
        const double density = visibility.density(place, sweep);
        if (density == 0) continue;
        sum += density;
        lattice.by_station[node * scanner.stations().size() + scanner.sweeps()[sweep].station] = true;
      }
      lattice.spacing[node] = sum > 0 ? static_cast<float>(1 / std::sqrt(sum)) : 0;
      lattice.sampled[node] = sum > 0;
    });
  }
  return lattices;
}

void close_gaps(std::vector<Lattice>& lattices, const Visibility& visibility, double hole_radius) {
  const std::vector<std::vector<float>> radii =
      radii_around(lattices, border_of(lattices, visibility, hole_radius));
  const SphereIndex rounds = rounds_of(lattices, radii);
  for (std::size_t i = 0; i < lattices.size(); ++i) {
    Lattice& lattice = lattices[i];
    for_each_node(lattice, [&](std::int32_t column, std::int32_t row, std::size_t node) {
      if (lattice.spacing[node] > 0 || radii[i][node] == 0) return;
      bool in_hole = false;
      rounds.for_each_around(lattice.at(column, row).position, [&](std::uint32_t) { in_hole = true; });
      if (in_hole) return;
      lattice.sampled[node] = 1;
      lattice.spacing[node] = radii[i][node] / static_cast<float>(hole_radius);
    });
  }
}

}  // namespace lacuna::synth
