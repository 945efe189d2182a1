// SPDX-License-Identifier: Apache-2.0
// Drawn and random clouds: `plane(40).punched({20, 20}, 5).jittered(0.25, 1).translated({1e6, 0, 0})`. They
// have equal numbers on every machine: nothing of <random> is used.
#pragma once

#include "engine/config/config.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// splitmix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next();
  double uniform();                                         // [0, 1)
  double uniform(double low, double high);                  // [low, high)
  std::int64_t whole(std::int64_t low, std::int64_t high);  // both included
  bool chance(double probability);
  double normal();              // standard normal, near enough
  Eigen::Vector3d direction();  // uniform on the unit sphere

 private:
  std::uint64_t state_;
};

// Points in input order: the index is the id. Every method returns a changed copy.
struct Cloud {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> normals;  // empty, or one per point

  std::size_t size() const { return positions.size(); }
  // A line "x y z" for each point, with all digits.
  std::string text() const;

  // Without the points nearer than `radius` to the vertical line through (x, y).
  Cloud punched(const Eigen::Vector2d& centre, double radius) const;
  // Moved by up to `amount` along x and along y.
  Cloud jittered(double amount, std::uint64_t seed) const;
  // Moved by a normal deviate of `amount` along every axis.
  Cloud noisy(double amount, std::uint64_t seed) const;
  Cloud scaled(double factor) const;
  Cloud translated(const Eigen::Vector3d& by) const;
  // About an axis through the origin, normals too.
  Cloud rotated(const Eigen::Vector3d& axis, double degrees) const;
  Cloud shuffled(std::uint64_t seed) const;
  // Every coordinate rounded to a multiple of `step`: exact ties, coincident points.
  Cloud rounded(double step) const;
  // The points of `other` follow. Normals are kept if both have them.
  Cloud joined(const Cloud& other) const;
  // `count` copies of points chosen at random follow.
  Cloud with_duplicates(std::size_t count, std::uint64_t seed) const;
  // `count` lone points follow, up to `distance` cloud diagonals away.
  Cloud with_outliers(std::size_t count, double distance, std::uint64_t seed) const;
  // `count` points chosen at random get a coordinate that is NaN or infinite.
  Cloud with_unusable(std::size_t count, std::uint64_t seed) const;
  // Random unit normals, some of them zero, NaN, infinite or not of unit length.
  Cloud with_random_normals(std::uint64_t seed) const;
};

// n x n points of the unit grid, (0, 0, 0) to (n - 1, n - 1, 0), x fastest.
Cloud plane(int n);
// n x n x n points of the unit grid: exact ties everywhere.
Cloud lattice(int n);
// n points of a Fibonacci spiral on the unit sphere: even, no ties.
Cloud sphere(int n);
// nu points around, nv rings a unit apart about the z axis; neighbours on a ring a unit apart too. Two outer
// edges.
Cloud open_cylinder(int nu, int nv);
// Two n x n half planes of the unit grid that join along the y axis.
Cloud crease(int n, double degrees = 90);
// The plane(n) where x < n / 2; beyond, every other point along both axes: a quarter of the density.
Cloud density_step(int n);
Cloud line(int n);
// n times the origin.
Cloud coincident(int n);
// n random points on the unit square, z = 0.
Cloud scattered(int n, std::uint64_t seed);

// All that breaks tilings, in one cloud of some 5,000 points about the size of 100, shuffled. It has density
// steps of 1 to 100, lone far outliers, lattices with exact ties, and 2,000 coincident points. It also has
// points on round coordinates (likely tile faces), islands of fewer points than k + 1, and unusable rows.
Cloud hard_cloud(std::uint64_t seed);

// 1 to 3,000 points: a random mixture of all of the above, placed, scaled and rotated at random.
Cloud random_cloud(std::uint64_t seed);

// All parameters of the method varied, each often left at its default. `spacing`: the typical distance
// between neighbours, eps being a length.
Config random_config(std::uint64_t seed, double spacing);
// Returns the config with the loops of the paper.
Config with_paper_loops(Config config);

Config tiled(Config config, std::int64_t tile_points, std::int64_t threads = 2);

// Median over the points of the distance to the nearest other; 1 where there is none.
double typical_spacing(const Cloud& cloud);

// ---- Large clouds whose points are spread so unevenly that memory per place has no bound by itself

// n random points of a wavy sheet over the unit square.
Cloud rough_sheet(int n, std::uint64_t seed);

// n random points in the unit cube: no surface at all.
Cloud volume(int n, std::uint64_t seed);

// The rough sheet, nine tenths of it shrunk to a millionth.
Cloud cluster(int n, std::uint64_t seed);

// A cluster whose shrunk part is a volume.
Cloud volume_cluster(int n, std::uint64_t seed);

// n points of a plane about the origin, as many in each decade of distance from 1e-6 to 1.
Cloud log_uniform(int n, std::uint64_t seed);

// n random points on a line.
Cloud random_line(int n, std::uint64_t seed);

// The rough sheet with 24 in 25 points at the origin, as scanners write for rays without a return.
Cloud zeros(int n, std::uint64_t seed);

// The rough sheet with one in 100 points anywhere, up to 1e6 away and often farther.
Cloud one_percent_far(int n, std::uint64_t seed);

}  // namespace lacuna
