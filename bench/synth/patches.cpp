// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/patches.hpp"

#include "bench/synth/trig.hpp"

#include <cmath>

namespace lacuna::synth {

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

}  // namespace lacuna::synth
