// SPDX-License-Identifier: Apache-2.0
#include "tests/support/clouds.hpp"

#include "engine/model/mixed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <utility>

#include <Eigen/Geometry>

namespace lacuna {

using Eigen::Vector3d;
using std::numbers::pi;

std::uint64_t Random::next() {
  return mixed(std::exchange(state_, state_ + 0x9e3779b97f4a7c15));
}

double Random::uniform() {
  return double(next() >> 11) * 0x1p-53;
}

double Random::uniform(double low, double high) {
  return low + (high - low) * uniform();
}

std::int64_t Random::whole(std::int64_t low, std::int64_t high) {
  return low + std::int64_t(next() % std::uint64_t(high - low + 1));
}

bool Random::chance(double probability) {
  return uniform() < probability;
}

double Random::normal() {
  double sum = 0;  // of 12 uniform deviates: variance 1
  for (int i = 0; i < 12; ++i) sum += uniform();
  return sum - 6;
}

Vector3d Random::direction() {
  for (;;) {
    const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    const Vector3d v(x, y, z);
    if (v.squaredNorm() > 0.01 && v.squaredNorm() <= 1) return v.normalized();
  }
}

std::string Cloud::text() const {
  std::ostringstream text;
  text.precision(17);
  for (const Vector3d& p : positions) text << p.transpose() << "\n";
  return text.str();
}

// ---- Changes -----------------------------------------------------------------------------------------

Cloud Cloud::punched(const Eigen::Vector2d& centre, double radius) const {
  Cloud result;
  for (std::size_t i = 0; i < size(); ++i) {
    if ((positions[i].head<2>() - centre).norm() < radius) continue;
    result.positions.push_back(positions[i]);
    if (!normals.empty()) result.normals.push_back(normals[i]);
  }
  return result;
}

Cloud Cloud::jittered(double amount, std::uint64_t seed) const {
  Random random(seed);
  Cloud result = *this;
  for (Vector3d& p : result.positions) {
    p.x() += random.uniform(-amount, amount);
    p.y() += random.uniform(-amount, amount);
  }
  return result;
}

Cloud Cloud::noisy(double amount, std::uint64_t seed) const {
  Random random(seed);
  Cloud result = *this;
  for (Vector3d& p : result.positions)
    for (double& coordinate : p) coordinate += amount * random.normal();
  return result;
}

Cloud Cloud::scaled(double factor) const {
  Cloud result = *this;
  for (Vector3d& p : result.positions) p *= factor;
  return result;
}

Cloud Cloud::translated(const Vector3d& by) const {
  Cloud result = *this;
  for (Vector3d& p : result.positions) p += by;
  return result;
}

Cloud Cloud::rotated(const Vector3d& axis, double degrees) const {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(degrees * pi / 180, axis.normalized()).toRotationMatrix();
  Cloud result = *this;
  for (Vector3d& p : result.positions) p = rotation * p;
  for (Vector3d& n : result.normals) n = rotation * n;
  return result;
}

Cloud Cloud::shuffled(std::uint64_t seed) const {
  Random random(seed);
  Cloud result = *this;
  for (std::size_t i = size(); i > 1; --i) {
    const auto j = std::size_t(random.whole(0, std::int64_t(i) - 1));
    std::swap(result.positions[i - 1], result.positions[j]);
    if (!normals.empty()) std::swap(result.normals[i - 1], result.normals[j]);
  }
  return result;
}

Cloud Cloud::rounded(double step) const {
  Cloud result = *this;
  for (Vector3d& p : result.positions)
    for (double& coordinate : p) coordinate = std::nearbyint(coordinate / step) * step;
  return result;
}

Cloud Cloud::joined(const Cloud& other) const {
  Cloud result = *this;
  result.positions.insert(result.positions.end(), other.positions.begin(), other.positions.end());
  result.normals.insert(result.normals.end(), other.normals.begin(), other.normals.end());
  if (result.normals.size() != result.size()) result.normals.clear();
  return result;
}

Cloud Cloud::with_duplicates(std::size_t count, std::uint64_t seed) const {
  Random random(seed);
  Cloud result = *this;
  for (std::size_t n = 0; n < count && size() > 0; ++n) {
    const auto i = std::size_t(random.whole(0, std::int64_t(size()) - 1));
    result.positions.push_back(positions[i]);
    if (!normals.empty()) result.normals.push_back(random.direction());
  }
  return result;
}

Cloud Cloud::with_outliers(std::size_t count, double distance, std::uint64_t seed) const {
  Random random(seed);
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : positions)
    if (p.allFinite()) box.extend(p);
  Cloud result = *this;
  for (std::size_t n = 0; n < count && !box.isEmpty(); ++n) {
    const double reach = random.uniform(0.2, 1) * distance * (box.diagonal().norm() + 1);
    result.positions.push_back(box.center() + reach * random.direction());
    if (!normals.empty()) result.normals.push_back(random.direction());
  }
  return result;
}

Cloud Cloud::with_unusable(std::size_t count, std::uint64_t seed) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kUnusable[] = {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity};
  Random random(seed);
  Cloud result = *this;
  for (std::size_t n = 0; n < count && size() > 0; ++n) {
    const std::int64_t i = random.whole(0, std::int64_t(size()) - 1);
    const std::int64_t axis = random.whole(0, 2);
    result.positions[std::size_t(i)][axis] = kUnusable[random.whole(0, 2)];
  }
  return result;
}

Cloud Cloud::with_random_normals(std::uint64_t seed) const {
  Random random(seed);
  Cloud result = *this;
  result.normals.clear();
  for (std::size_t i = 0; i < size(); ++i) {
    Vector3d n = random.direction();
    switch (random.whole(0, 9)) {
      case 0:
        n.setZero();
        break;
      case 1:
        n.y() = std::numeric_limits<double>::quiet_NaN();
        break;
      case 2:
        n.z() = std::numeric_limits<double>::infinity();
        break;
      case 3:
        n *= random.uniform(0.1, 100);
        break;
    }
    result.normals.push_back(n);
  }
  return result;
}

// ---- Drawn -------------------------------------------------------------------------------------------

Cloud plane(int n) {
  Cloud cloud;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) cloud.positions.emplace_back(x, y, 0);
  return cloud;
}

Cloud lattice(int n) {
  Cloud cloud;
  for (int z = 0; z < n; ++z) cloud = cloud.joined(plane(n).translated({0, 0, double(z)}));
  return cloud;
}

Cloud sphere(int n) {
  const double golden_angle = pi * (3 - std::sqrt(5.));
  Cloud cloud;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.) / n;
    const double r = std::sqrt(1 - z * z);
    cloud.positions.emplace_back(r * std::cos(golden_angle * i), r * std::sin(golden_angle * i), z);
  }
  return cloud;
}

Cloud open_cylinder(int nu, int nv) {
  const double radius = nu / (2 * pi);
  Cloud cloud;
  for (int v = 0; v < nv; ++v) {
    for (int u = 0; u < nu; ++u) {
      const double angle = 2 * pi * u / nu;
      cloud.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), v);
    }
  }
  return cloud;
}

Cloud crease(int n, double degrees) {
  const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
  Cloud cloud = plane(n);
  for (const Vector3d& p : plane(n).positions)
    if (p.x() > 0) cloud.positions.emplace_back(p.x() * c, p.y(), p.x() * s);
  return cloud;
}

Cloud density_step(int n) {
  Cloud cloud;
  for (const Vector3d& p : plane(n).positions) {
    const bool dense = p.x() < n / 2;
    const bool kept = (int(p.x()) - n / 2) % 2 == 0 && int(p.y()) % 2 == 0;
    if (dense || kept) cloud.positions.push_back(p);
  }
  return cloud;
}

Cloud line(int n) {
  Cloud cloud;
  for (int i = 0; i < n; ++i) cloud.positions.emplace_back(i, 0, 0);
  return cloud;
}

Cloud coincident(int n) {
  Cloud cloud;
  cloud.positions.assign(std::size_t(n), Vector3d(0, 0, 0));
  return cloud;
}

Cloud scattered(int n, std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform(), y = random.uniform();
    cloud.positions.emplace_back(x, y, 0);
  }
  return cloud;
}

// ---- Random ------------------------------------------------------------------------------------------

Cloud hard_cloud(std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  // Strips of a plane side by side, 16 wide and 16 long, each denser than the last.
  double x = 0;
  for (double density : {0.5, 1., 4., 1., 10., 0.5}) {
    const int count = int(16 * 16 * density);
    for (int i = 0; i < count; ++i) {
      const double px = x + random.uniform(0, 16), py = random.uniform(0, 16);
      cloud.positions.emplace_back(px, py, 0.01 * random.normal());
    }
    x += 16;
  }
  // A patch of 100 times the density of what is around it.
  cloud = cloud.joined(scattered(200, random.next()).scaled(2).translated({40, 4, 0}));
  // Ties across round coordinates, where tile faces are likely.
  cloud = cloud.joined(lattice(8).translated({16, 16, 16}));
  cloud = cloud.joined(plane(12).scaled(0.5).translated({64, 32, 0}));
  cloud = cloud.joined(plane(20).punched({10, 10}, 4).translated({-32, -32, 0}));
  // Many copies of one point, and points around it.
  cloud = cloud.joined(coincident(2000).translated({8, 8, 8}));
  cloud = cloud.joined(sphere(60).scaled(2).translated({8, 8, 8}));
  // Islands of fewer points than the wanted neighbours.
  for (int count : {1, 2, 3, 5, 9}) cloud = cloud.joined(sphere(count).translated({-20. * count, 70, 0}));
  cloud = cloud.joined(line(30).translated({0, 50, 0}));
  return cloud.with_outliers(6, 50, random.next()).with_unusable(20, random.next()).shuffled(random.next());
}

namespace {

Cloud random_piece(Random& random, int limit) {
  const int n = int(random.whole(1, std::max(1, limit)));
  const int side = std::max(1, int(std::sqrt(n)));
  switch (random.whole(0, 10)) {
    case 0:
      return plane(side);
    case 1:
      return plane(side).punched({side / 2., side / 2.}, side / 5.).jittered(0.25, random.next());
    case 2:
      return lattice(std::max(1, int(std::cbrt(n))));
    case 3:
      return sphere(n).scaled(std::sqrt(n) / 4);
    case 4:
      return open_cylinder(3 + side, std::max(1, n / (3 + side)));
    case 5:
      return crease(std::max(1, int(std::sqrt(n / 2)))).noisy(0.05, random.next());
    case 6:
      return density_step(side).jittered(0.2, random.next());
    case 7:
      return line(n);
    case 8:
      return coincident(n);
    case 9:
      return scattered(n, random.next()).scaled(side).rounded(0.25);
    default:
      return scattered(n, random.next()).scaled(side).noisy(0.1, random.next());
  }
}

}  // namespace

Cloud random_cloud(std::uint64_t seed) {
  Random random(seed);
  const int total = random.chance(0.15) ? int(random.whole(1, 20)) : int(random.whole(1, 3000));
  Cloud cloud;
  while (int(cloud.size()) < total) {
    Cloud piece = random_piece(random, total - int(cloud.size()));
    if (random.chance(0.5)) piece = piece.scaled(random.uniform(0.1, 4));
    if (random.chance(0.5)) piece = piece.rotated(random.direction(), random.uniform(0, 360));
    if (random.chance(0.7)) piece = piece.translated(random.uniform(0, 30) * random.direction());
    cloud = cloud.joined(piece);
  }
  if (random.chance(0.3)) cloud = cloud.with_duplicates(cloud.size() / 10, random.next());
  if (random.chance(0.3)) cloud = cloud.with_outliers(std::size_t(random.whole(1, 5)), 20, random.next());
  cloud.positions.resize(std::min(cloud.size(), std::size_t(total)));
  if (random.chance(0.3)) cloud = cloud.with_unusable(1 + cloud.size() / 50, random.next());
  if (random.chance(0.2)) cloud = cloud.translated(1e6 * random.direction());
  if (random.chance(0.25)) cloud = cloud.with_random_normals(random.next());
  return random.chance(0.7) ? cloud.shuffled(random.next()) : cloud;
}

Config random_config(std::uint64_t seed, double spacing) {
  Random random(seed);
  const auto varied = [&] { return random.chance(0.5); };
  Config config;
  config.scale.every_point = true;          // clouds of points at random places have lines here and there
  config.normals.use = NormalsUse::kGiven;  // random ones do not fit
  if (varied()) config.neighbourhood.k = random.whole(1, 30);
  if (random.chance(0.3)) config.neighbourhood.eps = random.uniform(0.5, 4) * spacing;
  if (config.neighbourhood.eps == 0 && random.chance(0.15))
    config.neighbourhood.eps_fraction = random.uniform(0.001, 0.05);
  if (varied()) config.normals.crease_threshold = random.uniform();
  config.normals.orient = varied();
  if (varied()) config.criteria.sigma = random.uniform(0.2, 3);
  if (varied()) config.criteria.cone = random.chance(0.2) ? 0 : random.uniform(0, 45);
  if (varied()) {
    config.criteria.weights[0] = random.uniform(0, 2);
    config.criteria.weights[1] = random.chance(0.2) ? 0 : random.uniform(0, 2);
    config.criteria.weights[2] = random.uniform(0.1, 2);
  }
  if (varied()) config.coherence.threshold = random.uniform(0.2, 0.8);
  if (varied()) config.spanning.max_prob_weight = random.uniform(0.5, 1.6);
  if (varied()) config.spanning.max_total_weight = random.uniform(2, 4);
  if (varied()) config.spanning.e = random.whole(2, 40);
  if (varied()) config.loops.method = LoopMethod::kPaper;
  if (varied()) config.selection.min_confidence = random.uniform();
  if (random.chance(0.3)) {
    TangentialConfig& tangential = config.tangential;
    tangential.seed_probability = random.uniform(0.2, 0.9);
    tangential.max_radius = random.uniform(1, 3);
    tangential.hole_radius = random.uniform(0.5, 2);
    tangential.most_radius = random.uniform(0.2, 0.8);
    tangential.coarse_bound = random.uniform(1, 4);
    tangential.clear_radius = random.uniform(1.2, 4);
    tangential.added_length = random.uniform(0, 12);
    tangential.min_curve = random.whole(3, 20);
  }
  return config;
}

Config with_paper_loops(Config config) {
  config.loops.method = LoopMethod::kPaper;
  return config;
}

Config tiled(Config config, std::int64_t tile_points, std::int64_t threads) {
  config.run.tile_points = tile_points;
  config.run.threads = threads;
  return config;
}

double typical_spacing(const Cloud& cloud) {
  std::vector<double> nearest;
  for (std::size_t i = 0; i < cloud.size(); i += 1 + cloud.size() / 100) {
    double squared = std::numeric_limits<double>::infinity();
    for (const Vector3d& q : cloud.positions) {
      const double d = (q - cloud.positions[i]).squaredNorm();
      if (d > 0 && d < squared) squared = d;
    }
    if (std::isfinite(squared)) nearest.push_back(std::sqrt(squared));
  }
  if (nearest.empty()) return 1;
  std::nth_element(nearest.begin(), nearest.begin() + nearest.size() / 2, nearest.end());
  return nearest[nearest.size() / 2];
}

// ---- Points that are spread unevenly

Cloud rough_sheet(int n, std::uint64_t seed) {
  Cloud cloud = scattered(n, seed);
  for (Eigen::Vector3d& p : cloud.positions) p.z() = 0.05 * std::sin(9 * p.x());
  return cloud;
}

Cloud volume(int n, std::uint64_t seed) {
  Cloud cloud = scattered(n, seed);
  Random random(seed + 1);
  for (Eigen::Vector3d& p : cloud.positions) p.z() = random.uniform();
  return cloud;
}

Cloud cluster(int n, std::uint64_t seed) {
  const Cloud small = rough_sheet(n / 10 * 9, seed).scaled(1e-6).translated({0.5, 0.5, 0.1});
  return small.joined(rough_sheet(n / 10, seed + 1)).shuffled(seed);
}

Cloud volume_cluster(int n, std::uint64_t seed) {
  const Cloud small = volume(n / 10 * 9, seed).scaled(1e-6).translated({0.5, 0.5, 0.1});
  return small.joined(rough_sheet(n / 10, seed + 1));
}

Cloud log_uniform(int n, std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  for (int i = 0; i < n; ++i) {
    const double distance = std::pow(10, random.uniform(-6, 0));
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    cloud.positions.emplace_back(distance * std::cos(angle), distance * std::sin(angle), 0);
  }
  return cloud;
}

Cloud random_line(int n, std::uint64_t seed) {
  Cloud cloud = scattered(n, seed);
  for (Eigen::Vector3d& p : cloud.positions) p.y() = 0;
  return cloud;
}

Cloud zeros(int n, std::uint64_t seed) {
  return rough_sheet(n / 25, seed).joined(coincident(n - n / 25)).shuffled(seed);
}

// Coordinates of outliers have Cauchy's distribution.
Cloud one_percent_far(int n, std::uint64_t seed) {
  Cloud cloud = rough_sheet(n, seed);
  Random random(seed + 1);
  const auto far = [&] { return 1e6 * std::tan(std::numbers::pi * (random.uniform() - 0.5)); };
  for (int i = 0; i < n / 100; ++i) {
    Eigen::Vector3d& p = cloud.positions[std::size_t(random.whole(0, n - 1))];
    p.x() = far();
    p.y() = far();
    p.z() = far();
  }
  return cloud;
}

}  // namespace lacuna
