// SPDX-License-Identifier: Apache-2.0
// The true loops of a scanned scene.
#pragma once

#include "bench/synth/boundary_curves.hpp"
#include "bench/synth/sphere_index.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lacuna::synth {

struct NamedLoop {
  std::vector<std::uint64_t> ids;  // each once, in order
  std::string name;                // what it is, such as "window"
};

// A true loop is the sequence of points that are nearest to a place on a boundary curve, as the place goes
// around. Only points on the surface of the place count. They count where they would lie without noise,
// strays and errors of registration, so these errors change nothing. The curves are the edges of the
// surface's holes and its outer edges. Steps of density (density_steps.hpp) become sequences of points in the
// same way.
class ScanTruth {
 public:
  explicit ScanTruth(const Scanner& scanner, std::uint64_t points);

  // Records that the echo of this ray was written as the `id`-th point.
  void note(const Echo& echo, std::uint64_t ray, std::uint64_t id);

  // Call it after every echo is recorded. Returns each loop from its smallest id towards the smaller
  // neighbour of this id, sorted. Loops with fewer than 12 points are left out. So are loops where points are
  // rare, and loops with much of their edge in closed gaps.
  std::vector<NamedLoop> loops() const;

  // The same of holes too narrow to count: at least half as wide as the narrowest ones that do.
  std::vector<std::vector<std::uint64_t>> narrow_loops() const;

  // Call it after every echo is recorded. Returns the points along each step, 12 or more, sorted. Where a
  // sequence is closed, its first point is its last, too.
  std::vector<std::vector<std::uint64_t>> steps() const;

 private:
  struct NearestEcho {
    std::uint32_t shape;
    double nearest;  // squared
    std::uint64_t ray, id;
  };
  enum class Kind : std::uint8_t { kLoop, kNarrow, kStep };
  struct Row {
    std::size_t begin, end;  // places
    Kind kind;
    std::string name;  // of a loop
  };

  void add(const Curve& curve, double least_step, Kind kind, std::string name, std::vector<Sphere>& spheres);
  std::vector<std::uint64_t> ids_along(const Row& row) const;
  std::vector<NamedLoop> closed_rows(Kind kind) const;

  std::vector<NearestEcho> places_;
  std::vector<Row> rows_;
  SphereIndex index_;
};

}  // namespace lacuna::synth
