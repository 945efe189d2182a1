// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/sampled_surface.hpp"

#include "bench/synth/arithmetic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace lacuna::synth {

// ---- Patches

namespace {

constexpr double kInset = 1e-4;  // metres
constexpr Vec3 kUp{0, 0, 1};

// Maps [0, 1] to the inside of [-half, half].
double across(double share, double half) {
  return (2 * share - 1) * (half - kInset);
}

void add_patches(const Wall& wall, std::uint32_t shape, std::vector<Patch>& patches) {
  const Vec3 middle = wall.corner + 0.5 * wall.width * wall.u + 0.5 * wall.height * wall.v;
  const auto place = [wall, middle](double u, double v) {
    return middle + across(u, 0.5 * wall.width) * wall.u + across(v, 0.5 * wall.height) * wall.v;
  };
  const Vec3 normal = cross(wall.u, wall.v);
  patches.push_back(
      {shape, true, wall.width, wall.height, place, [normal](double, double) { return normal; }});
}

void add_patches(const Box& box, std::uint32_t shape, std::vector<Patch>& patches) {
  const Vec3 axes[3] = {turned_back(box, {1, 0, 0}), turned_back(box, {0, 1, 0}), {0, 0, 1}};
  const double halves[3] = {box.half.x, box.half.y, box.half.z};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 along_u = axes[(axis + 1) % 3], along_v = axes[(axis + 2) % 3];
    const double half_u = halves[(axis + 1) % 3], half_v = halves[(axis + 2) % 3];
    for (const double side : {-1.0, 1.0}) {
      const Vec3 normal = side * axes[axis];
      const Vec3 middle = box.centre + halves[axis] * normal;
      const auto place = [=](double u, double v) {
        return middle + across(u, half_u) * along_u + across(v, half_v) * along_v;
      };
      patches.push_back(
          {shape, false, 2 * half_u, 2 * half_v, place, [normal](double, double) { return normal; }});
    }
  }
}

// Adds the faces of a cube that is blown up to a sphere.
void add_patches(const Ball& ball, std::uint32_t shape, std::vector<Patch>& patches) {
  constexpr Vec3 kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double size = 0.25 * kTwoPi * ball.radius;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto normal = [=](double u, double v) {
        return normalized(side * kAxes[axis] + (2 * u - 1) * kAxes[(axis + 1) % 3] +
                          (2 * v - 1) * kAxes[(axis + 2) % 3]);
      };
      const auto place = [=](double u, double v) { return ball.centre + ball.radius * normal(u, v); };
      patches.push_back({shape, false, size, size, place, normal});
    }
  }
}

void add_patches(const Column& column, std::uint32_t shape, std::vector<Patch>& patches) {
  for (int quarter = 0; quarter < 4; ++quarter) {
    const auto normal = [=](double u, double) {
      const auto [sine, cosine] = sin_cos(0.25 * (quarter + u));
      return Vec3{cosine, sine, 0};
    };
    const auto place = [=](double u, double v) {
      const double z = 0.5 * column.height + across(v, 0.5 * column.height);
      return column.base + column.radius * normal(u, v) + Vec3{0, 0, z};
    };
    patches.push_back({shape, false, 0.25 * kTwoPi * column.radius, column.height, place, normal});
  }
  // The elliptical map from a square to a disc.
  const auto lid = [=](double u, double v) {
    const double x = 2 * u - 1, y = 2 * v - 1, radius = column.radius - kInset;
    return column.base + Vec3{radius * x * std::sqrt(1 - 0.5 * y * y),
                              radius * y * std::sqrt(1 - 0.5 * x * x), column.height};
  };
  patches.push_back({shape, false, 2 * column.radius, 2 * column.radius, lid, [](double, double) {
                       return Vec3{0, 0, 1};
                     }});
}

// A part of a cylinder's inside or outside, `turns` of it from `first` on. `side` and `up` are at
// right angles to its axis and to each other.
struct Arc {
  Vec3 start, along;
  double length, radius;
  Vec3 side, up;
};

Patch patch_of(const Arc& arc, double first, double turns, std::uint32_t shape, bool two_sided) {
  const auto normal = [=](double u, double) {
    const auto [sine, cosine] = sin_cos(first + turns * u);
    return cosine * arc.side + sine * arc.up;
  };
  const auto place = [=](double u, double v) {
    const double along = 0.5 * arc.length + across(v, 0.5 * arc.length);
    return arc.start + along * arc.along + arc.radius * normal(u, v);
  };
  return {shape, two_sided, turns * kTwoPi * arc.radius, arc.length, place, normal};
}

void add_patches(const Pipe& pipe, std::uint32_t shape, std::vector<Patch>& patches) {
  const Vec3 side = normalized(cross(pipe.along, std::fabs(pipe.along.z) < 0.9 ? kUp : Vec3{1, 0, 0}));
  const Arc arc{pipe.start, pipe.along, pipe.length, pipe.radius, side, cross(side, pipe.along)};
  for (int quarter = 0; quarter < 4; ++quarter)
    patches.push_back(patch_of(arc, 0.25 * quarter, 0.25, shape, false));
}

void add_patches(const Vault& vault, std::uint32_t shape, std::vector<Patch>& patches) {
  const Arc arc{vault.start, vault.along, vault.length, vault.radius, cross(vault.along, kUp), kUp};
  patches.push_back(patch_of(arc, 0, 0.5, shape, true));
}

void add_patches(const House& house, std::uint32_t shape, std::vector<Patch>& patches) {
  const auto add = [&](double width, double height, Vec3 normal, const auto& own_place) {
    const auto place = [=](double u, double v) { return house.base + turned_back(house, own_place(u, v)); };
    const Vec3 outward = turned_back(house, normalized(normal));
    patches.push_back({shape, false, width, height, place, [outward](double, double) { return outward; }});
  };
  const double pitch = house.rise / house.half_width;
  const double slope = house.half_width * std::sqrt(1 + pitch * pitch);
  const double half_x = house.half_length, half_y = house.half_width, eaves = house.eaves;
  for (const double side : {-1.0, 1.0}) {
    add(2 * half_x, eaves, {0, side, 0}, [=](double u, double v) {
      return Vec3{across(u, half_x), side * half_y, 0.5 * eaves + across(v, 0.5 * eaves)};
    });
    add(2 * half_y, eaves + house.rise, {side, 0, 0}, [=](double u, double v) {
      const double y = across(u, half_y), half = 0.5 * house.top(y);
      return Vec3{side * half_x, y, half + across(v, half)};
    });
    add(2 * half_x, slope, {0, side * pitch, 1}, [=](double u, double v) {
      const double y = 0.5 * half_y + across(v, 0.5 * half_y);
      return Vec3{across(u, half_x), side * y, house.top(y)};
    });
  }
}

void add_patches(const Terrain& terrain, std::uint32_t shape, std::vector<Patch>& patches) {
  const auto x = [length = terrain.length](double u) { return 0.5 * length + across(u, 0.5 * length); };
  const auto y = [width = terrain.width](double v) { return 0.5 * width + across(v, 0.5 * width); };
  const auto place = [=](double u, double v) { return Vec3{x(u), y(v), terrain.height(x(u), y(v))}; };
  const auto normal = [=](double u, double v) { return normalized(kUp - terrain.slope(x(u), y(v))); };
  patches.push_back({shape, false, terrain.length, terrain.width, place, normal});
}

}  // namespace

std::vector<Patch> patches_of(const Scene& scene) {
  std::vector<Patch> patches;
  for_each_shape(scene, [&](const auto& shape, std::uint32_t number) {
    if (shape.reflectance > 0) add_patches(shape, number, patches);
  });
  return patches;
}

// ---- Spheres around a place

SphereIndex::SphereIndex(std::vector<Sphere> spheres) : spheres_(std::move(spheres)) {
  for (std::uint32_t number = 0; number < spheres_.size(); ++number) {
    const auto& [centre, radius] = spheres_[number];
    Level level{};
    std::frexp(2 * radius, &level.exponent);
    level.cells_per_metre = std::ldexp(1.0, -level.exponent);
    levels_.push_back(level);
    const auto low = [&](double at) { return cell(at - radius, level); };
    const auto high = [&](double at) { return cell(at + radius, level); };
    for (std::int64_t x = low(centre.x); x <= high(centre.x); ++x)
      for (std::int64_t y = low(centre.y); y <= high(centre.y); ++y)
        for (std::int64_t z = low(centre.z); z <= high(centre.z); ++z)
          entries_.emplace_back(key_of(level, x, y, z), number);
  }
  std::sort(levels_.begin(), levels_.end());
  levels_.erase(std::unique(levels_.begin(), levels_.end()), levels_.end());
  std::sort(entries_.begin(), entries_.end());
  std::uint64_t size = 1024;
  while (size < 16 * entries_.size()) size *= 2;
  mask_ = size - 1;
  present_.resize(size);
  for (const auto& entry : entries_) present_[entry.first & mask_] = true;
}

// ---- Which nodes are sampled

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
