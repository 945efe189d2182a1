#include "tools/synth/patches.hpp"

#include "tools/synth/trig.hpp"

#include <cmath>

namespace lacuna::synth {

namespace {

constexpr double kInset = 1e-4;  // metres

// From [0, 1] to the inside of [-half, half].
double across(double share, double half) {
  return (2 * share - 1) * (half - kInset);
}

Patch patch_of(const Wall& wall, std::uint32_t shape) {
  const Vec3 middle = wall.corner + 0.5 * wall.width * wall.u + 0.5 * wall.height * wall.v;
  const auto place = [wall, middle](double u, double v) {
    return middle + across(u, 0.5 * wall.width) * wall.u + across(v, 0.5 * wall.height) * wall.v;
  };
  const Vec3 normal = cross(wall.u, wall.v);
  return {shape, true, wall.width, wall.height, place, [normal](double, double) { return normal; }};
}

void add_faces(const Box& box, std::uint32_t shape, std::vector<Patch>& patches) {
  const auto outward = [&](Vec3 a) {
    return Vec3{box.cosine * a.x - box.sine * a.y, box.sine * a.x + box.cosine * a.y, a.z};
  };
  const Vec3 axes[3] = {outward({1, 0, 0}), outward({0, 1, 0}), outward({0, 0, 1})};
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

// The faces of a cube, blown up.
void add_panels(const Ball& ball, std::uint32_t shape, std::vector<Patch>& patches) {
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

void add_panels(const Column& column, std::uint32_t shape, std::vector<Patch>& patches) {
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

}  // namespace

std::vector<Patch> patches_of(const Scene& scene) {
  std::vector<Patch> patches;
  std::uint32_t shape = 0;
  for (const Wall& wall : scene.walls) {
    if (wall.reflectance > 0) patches.push_back(patch_of(wall, shape));
    ++shape;
  }
  for (const Box& box : scene.boxes) {
    if (box.reflectance > 0) add_faces(box, shape, patches);
    ++shape;
  }
  for (const Ball& ball : scene.balls) {
    if (ball.reflectance > 0) add_panels(ball, shape, patches);
    ++shape;
  }
  for (const Column& column : scene.columns) {
    if (column.reflectance > 0) add_panels(column, shape, patches);
    ++shape;
  }
  return patches;
}

}  // namespace lacuna::synth
