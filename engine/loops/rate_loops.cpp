// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/rate_loops.hpp"

#include "engine/loops/confidence.hpp"
#include "engine/loops/loop_plane.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna {
namespace {

constexpr std::uint32_t kNowhere = UINT32_MAX;

class Raster {
 public:
  Raster(const Eigen::AlignedBox2d& box, double spacing) {
    constexpr double kFewest = 24, kMost = 255;  // pixels of the longer side
    const double side = box.sizes().maxCoeff();
    edge = std::clamp(spacing / 2, side / kMost, side / kFewest);
    columns = static_cast<std::uint32_t>(box.sizes().x() / edge) + 1;
    rows = static_cast<std::uint32_t>(box.sizes().y() / edge) + 1;
    corner_ = box.center() - edge / 2 * Eigen::Vector2d(columns, rows);
  }
  std::size_t size() const { return std::size_t{columns} * rows; }
  std::uint32_t pixel(std::uint32_t column, std::uint32_t row) const { return row * columns + column; }
  // Returns the pixel over which a place lies, or kNowhere.
  std::uint32_t pixel_at(const Eigen::Vector3d& place) const {
    const double column = std::floor((place.x() - corner_.x()) / edge),
                 row = std::floor((place.y() - corner_.y()) / edge);
    if (!(column >= 0 && column < columns && row >= 0 && row < rows)) return kNowhere;
    return pixel(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row));
  }
  double y(std::uint32_t row) const { return corner_.y() + (row + 0.5) * edge; }
  // Return the first row, or column, whose middle is not below a coordinate.
  std::uint32_t first_row(double y) const { return first((y - corner_.y()) / edge, rows); }
  std::uint32_t first_column(double x) const { return first((x - corner_.x()) / edge, columns); }
  // Returns the squared distance of two pixels, in edges.
  std::uint32_t squared_distance(std::uint32_t a, std::uint32_t b) const {
    const std::int32_t x = static_cast<std::int32_t>(a % columns) - static_cast<std::int32_t>(b % columns),
                       y = static_cast<std::int32_t>(a / columns) - static_cast<std::int32_t>(b / columns);
    return static_cast<std::uint32_t>(x * x + y * y);
  }

  double edge;
  std::uint32_t columns, rows;

 private:
  static std::uint32_t first(double place, std::uint32_t most) {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(place - 0.5), 0.0, static_cast<double>(most)));
  }
  Eigen::Vector2d corner_;
};

// Returns for each pixel the row of the nearest marked pixel in its column, of two equally near ones the
// first, or kNowhere.
std::span<std::uint32_t> nearest_in_column(const Raster& raster, std::span<const std::uint8_t> is_marked,
                                           Scratch& scratch) {
  const std::span<std::uint32_t> nearest = scratch.array<std::uint32_t>(raster.size());
  for (std::uint32_t column = 0; column < raster.columns; ++column) {
    std::uint32_t last = kNowhere;
    for (std::uint32_t row = 0; row < raster.rows; ++row) {
      const std::uint32_t at = raster.pixel(column, row);
      if (is_marked[at] != 0) last = row;
      nearest[at] = last;
    }
    last = kNowhere;
    for (std::uint32_t row = raster.rows; row-- > 0;) {
      const std::uint32_t at = raster.pixel(column, row);
      if (is_marked[at] != 0) last = row;
      if (last != kNowhere && (nearest[at] == kNowhere || last - row < row - nearest[at])) nearest[at] = last;
    }
  }
  return nearest;
}

// Returns for each pixel the nearest marked one, of those equally near the first along its row, or kNowhere.
// Along a row, each column is nearest over one run of pixels, which ends where the next one is nearer. Cost:
// linear. Source: Felzenszwalb, Huttenlocher 2012.
std::span<std::uint32_t> nearest_marked(const Raster& raster, std::span<const std::uint8_t> is_marked,
                                        Scratch& scratch) {
  struct Run {
    std::int32_t begin, column, squared_height;
  };
  const std::span<std::uint32_t> in_column = nearest_in_column(raster, is_marked, scratch);
  const std::span<std::uint32_t> nearest = scratch.array<std::uint32_t>(raster.size());
  const auto columns = static_cast<std::int32_t>(raster.columns);
  std::vector<Run> runs;
  for (std::uint32_t row = 0; row < raster.rows; ++row) {
    const std::uint32_t* const along = &in_column[raster.pixel(0, row)];
    runs.clear();
    for (std::int32_t column = 0; column < columns; ++column) {
      if (along[column] == kNowhere) continue;
      const std::int32_t height = static_cast<std::int32_t>(along[column]) - static_cast<std::int32_t>(row);
      Run run{0, column, height * height};
      while (!runs.empty()) {
        const Run& before = runs.back();
        const std::int32_t twice =
            column * column - before.column * before.column + run.squared_height - before.squared_height;
        run.begin = twice < 0 ? 0 : twice / (2 * (column - before.column)) + 1;
        if (run.begin > before.begin) break;
        runs.pop_back();
        run.begin = 0;
      }
      if (run.begin < columns) runs.push_back(run);
    }
    std::uint32_t* const to = &nearest[raster.pixel(0, row)];
    if (runs.empty()) std::fill(to, to + columns, kNowhere);
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const std::int32_t end = r + 1 < runs.size() ? runs[r + 1].begin : columns;
      const auto column = static_cast<std::uint32_t>(runs[r].column);
      std::fill(to + runs[r].begin, to + end, raster.pixel(column, along[column]));
    }
  }
  return nearest;
}

// Calls visit(point) for each point in the box, and for some around it. Cells are read many at a time: a
// call of the system costs more than the points of a cell.
template <class Visit>
void for_each_point_near(const TileStore& store, const Eigen::AlignedBox3d& box, Visit&& visit) {
  constexpr std::size_t kCells = 512;
  const Tiling& tiling = store.tiling();
  std::vector<std::uint32_t> nodes(tiling.nodes.empty() ? 0 : 1), cells;
  std::vector<ScanPoint> points;
  std::vector<Row> rows;
  const auto read = [&] {
    store.read_cells(cells, points, rows);
    for (const ScanPoint& point : points) visit(point.position());
    cells.clear();
  };
  while (!nodes.empty()) {
    const CellNode& node = tiling.nodes[nodes.back()];
    nodes.pop_back();
    if (!node.box.intersects(box)) continue;
    if (node.left != 0) {
      nodes.insert(nodes.end(), {node.right, node.left});
      continue;
    }
    for (std::uint32_t cell = node.first; cell < node.last; ++cell) {
      if (Eigen::AlignedBox3d(tiling.cells[cell].box).intersects(box)) cells.push_back(cell);
    }
    if (cells.size() >= kCells) read();
  }
  read();
}

// Returns a direction in the plane of the normal: across the axis that it is least along. It changes little
// with the normal.
Eigen::Vector3d across(const Eigen::Vector3d& normal) {
  Eigen::Index least = 0;
  normal.cwiseAbs().minCoeff(&least);
  return normal.cross(Eigen::Vector3d::Unit(least)).normalized();
}

// A loop in its plane, with its surroundings: as wide as the loop.
struct FlatLoop {
  LoopPlane plane;
  double width;  // of the surroundings, and the largest height of their points over the loop
  Eigen::AlignedBox3d box = {};

  FlatLoop(std::span<const LoopPoint> loop, const LoopShape& shape, Scratch& scratch)
      : plane(shape.centroid, shape.normal, across(shape.normal)), width(2 * shape.area / shape.perimeter) {
    scratch.for_each(loop, [&](const LoopPoint& p) { box.extend(plane(p.position())); });
    box.min().array() -= width;
    box.max().array() += width;
  }
  Eigen::AlignedBox2d flat_box() const { return {box.min().head<2>().eval(), box.max().head<2>().eval()}; }
  // Returns a box around the loop, its surroundings and a margin.
  Eigen::AlignedBox3d box_in_space(double margin) const {
    const Eigen::AlignedBox3d wider(box.min().array() - margin, box.max().array() + margin);
    Eigen::AlignedBox3d space;
    for (int i = 0; i < 8; ++i)
      space.extend(plane.point_at(wider.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i))));
    return space;
  }
};

// Marks the pixels that lie within the loop: those with an odd number of edges to their right.
void mark_within(std::span<const LoopPoint> loop, const LoopPlane& plane, const Raster& raster,
                 std::span<std::uint8_t> is_within, Scratch& scratch) {
  Eigen::Vector3d a = plane(loop.back().position());
  scratch.for_each(loop, [&](const LoopPoint& p) {
    const Eigen::Vector3d b = plane(p.position());
    const std::uint32_t last = raster.first_row(std::max(a.y(), b.y()));
    for (std::uint32_t row = raster.first_row(std::min(a.y(), b.y())); row < last; ++row) {
      const double x = a.x() + (raster.y(row) - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      const std::uint32_t end = raster.first_column(x);
      for (std::uint32_t column = 0; column < end; ++column) is_within[raster.pixel(column, row)] ^= 1;
    }
    a = b;
  });
}

}  // namespace

double prominence(const TileStore& points, std::span<const LoopPoint> loop, const LoopShape& shape,
                  double spacing, Scratch& scratch) {
  constexpr double kGap = 0.9;  // of the pixels around the hole are nearer to a point than its gap
  // Within the hole, points count up to this part of the width: a surface that lies higher or lower is
  // another.
  constexpr double kSheet = 0.2;
  if (!(shape.area > 0) || !std::isfinite(shape.area)) return 0;
  const FlatLoop flat(loop, shape, scratch);
  const Raster raster(flat.flat_box(), spacing);
  const auto marks = [&] { return scratch.array<std::uint8_t>(raster.size()); };

  const std::span<std::uint8_t> is_within = marks(), is_on_loop = marks(), is_sampled = marks();
  const std::span<float> height = scratch.array<float>(raster.size());
  mark_within(loop, flat.plane, raster, is_within, scratch);
  scratch.for_each(loop, [&](const LoopPoint& p) {
    const Eigen::Vector3d at = flat.plane(p.position());
    const std::uint32_t pixel = raster.pixel_at(at);
    is_on_loop[pixel] = 1;
    height[pixel] = static_cast<float>(at.z());
  });
  const std::span<const std::uint32_t> to_loop = nearest_marked(raster, is_on_loop, scratch);
  // The raster is up to half a pixel wider than the box on each side. Its points count, whatever their cells.
  for_each_point_near(points, flat.box_in_space(raster.edge), [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d at = flat.plane(point);
    const std::uint32_t pixel = raster.pixel_at(at);
    if (pixel == kNowhere) return;
    const double most = is_within[pixel] != 0 ? kSheet * flat.width : flat.width;
    if (std::abs(at.z() - height[to_loop[pixel]]) <= most) is_sampled[pixel] = 1;
  });

  const std::span<const std::uint32_t> to_sample = nearest_marked(raster, is_sampled, scratch);
  const double most_around = flat.width * flat.width / (raster.edge * raster.edge);
  std::uint32_t deepest = 0;
  std::vector<std::uint32_t> around;
  for (std::uint32_t pixel = 0; pixel < raster.size(); ++pixel) {
    if (to_sample[pixel] == kNowhere) continue;
    const std::uint32_t distance = raster.squared_distance(pixel, to_sample[pixel]);
    if (is_within[pixel] != 0) {
      deepest = std::max(deepest, distance);
    } else if (raster.squared_distance(pixel, to_loop[pixel]) <= most_around) {
      around.push_back(distance);
    }
  }
  const auto gap = around.begin() + static_cast<std::ptrdiff_t>(kGap * static_cast<double>(around.size()));
  std::nth_element(around.begin(), gap, around.end());
  // Half a pixel more: a distance is known to no more than that.
  const double of_gap = around.empty() ? 0 : std::sqrt(*gap);
  return (std::sqrt(deepest) + 0.5) / (of_gap + 0.5);
}

void rate_loops(const TileStore& points, Loops& loops, const Spill& spill, const Workers& workers) {
  for_each_loop(loops, spill, workers, [&](std::size_t i, std::span<const LoopPoint> loop, Scratch& scratch) {
    const LoopShape shape = shape_of(loop, scratch);
    LoopEvidence evidence = loops.evidence(i);
    evidence.width = 2 * shape.area / shape.perimeter / evidence.spacing;
    evidence.compactness = evidence.width / static_cast<double>(loop.size());
    evidence.kind = shape.kind;
    if (evidence.kind == LoopKind::kHole && could_be_probable(evidence))
      evidence.prominence = prominence(points, loop, shape, evidence.spacing, scratch);
    loops.set_evidence(i, evidence);
  });
}

}  // namespace lacuna
