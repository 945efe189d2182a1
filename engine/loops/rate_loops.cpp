// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/rate_loops.hpp"

#include "engine/loops/confidence.hpp"
#include "engine/loops/loop_plane.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
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

// Calls visit(point) for each point in the boxes, and for some around them. Cells are read many at a time: a
// call of the system costs more than the points of a cell.
template <class Visit>
void for_each_point_near(const TileStore& store, std::span<const Eigen::AlignedBox3d> boxes, Visit&& visit) {
  constexpr std::size_t kCells = 512;
  const Tiling& tiling = store.tiling();
  std::vector<std::uint32_t> nodes(tiling.nodes.empty() ? 0 : 1), cells;
  std::vector<ScanPoint> points;
  std::vector<Row> rows;
  const auto is_near = [&](const Eigen::AlignedBox3d& of_cells) {
    return std::any_of(boxes.begin(), boxes.end(), [&](const auto& box) { return of_cells.intersects(box); });
  };
  const auto read = [&] {
    store.read_cells(cells, points, rows);
    for (const ScanPoint& point : points) visit(point.position());
    cells.clear();
  };
  while (!nodes.empty()) {
    const CellNode& node = tiling.nodes[nodes.back()];
    nodes.pop_back();
    if (!is_near(node.box)) continue;
    if (node.left != 0) {
      nodes.insert(nodes.end(), {node.right, node.left});
      continue;
    }
    for (std::uint32_t cell = node.first; cell < node.last; ++cell) {
      if (is_near(Eigen::AlignedBox3d(tiling.cells[cell].box))) cells.push_back(cell);
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

// A loop in its plane, and its box there.
struct FlatLoop {
  LoopPlane plane;
  Eigen::AlignedBox3d box = {};

  FlatLoop(std::span<const LoopPoint> loop, const LoopShape& shape, Scratch& scratch)
      : plane(shape.centroid, shape.normal, across(shape.normal)) {
    scratch.for_each(loop, [&](const LoopPoint& p) { box.extend(plane(p.position())); });
  }
};

Eigen::AlignedBox2d seen_from_above(const Eigen::AlignedBox3d& box) {
  return {box.min().head<2>().eval(), box.max().head<2>().eval()};
}

Eigen::AlignedBox3d widened(const Eigen::AlignedBox3d& box, double margin) {
  return {(box.min().array() - margin).matrix(), (box.max().array() + margin).matrix()};
}

// Returns the box in space around a box in a plane.
Eigen::AlignedBox3d in_space(const LoopPlane& plane, const Eigen::AlignedBox3d& box) {
  Eigen::AlignedBox3d space;
  for (int i = 0; i < 8; ++i)
    space.extend(plane.point_at(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i))));
  return space;
}

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
  // The surroundings are as wide as the loop, and as high.
  const double width = 2 * shape.area / shape.perimeter;
  const Eigen::AlignedBox3d box = widened(flat.box, width);
  const Raster raster(seen_from_above(box), spacing);
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
  const Eigen::AlignedBox3d wanted = in_space(flat.plane, widened(box, raster.edge));
  for_each_point_near(points, {&wanted, 1}, [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d at = flat.plane(point);
    const std::uint32_t pixel = raster.pixel_at(at);
    if (pixel == kNowhere) return;
    const double most = is_within[pixel] != 0 ? kSheet * width : width;
    if (std::abs(at.z() - height[to_loop[pixel]]) <= most) is_sampled[pixel] = 1;
  });

  const std::span<const std::uint32_t> to_sample = nearest_marked(raster, is_sampled, scratch);
  const double most_around = width * width / (raster.edge * raster.edge);
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

namespace {

// Returns the share of the points over the curve that lie far from its plane, of those within its radius.
double volume_over(const TileStore& points, std::span<const LoopPoint> loop, const FlatLoop& flat,
                   double radius, double spacing, Scratch& scratch) {
  const double far = std::max(0.12 * radius, 2 * spacing);
  const Raster raster(seen_from_above(flat.box), spacing);
  const std::span<std::uint8_t> is_within = scratch.array<std::uint8_t>(raster.size());
  mark_within(loop, flat.plane, raster, is_within, scratch);
  Eigen::AlignedBox3d box = flat.box;
  box.min().z() = -radius;
  box.max().z() = radius;
  const Eigen::AlignedBox3d wanted = in_space(flat.plane, widened(box, raster.edge));
  std::uint64_t all = 0, are_far = 0;
  for_each_point_near(points, {&wanted, 1}, [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d at = flat.plane(point);
    const std::uint32_t pixel = raster.pixel_at(at);
    if (pixel == kNowhere || is_within[pixel] == 0 || std::abs(at.z()) > radius) return;
    ++all;
    if (std::abs(at.z()) > far) ++are_far;
  });
  return all == 0 ? 0 : static_cast<double>(are_far) / static_cast<double>(all);
}

// Calls visit(height) for each point of the curve: the least difference in height, in spacings, to a point
// that lies beyond it. Points lie beyond it in a strip outward, across the curve. Without one, it is
// infinite.
template <class Visit>
void for_each_height_beyond(const TileStore& points, std::span<const LoopPoint> loop, const LoopPlane& plane,
                            double spacing, Scratch& scratch, Visit&& visit) {
  constexpr double kNear = 0.7, kFar = 4, kAside = 1.2, kHigh = 2.5;  // of the strip, in spacings
  constexpr double kReach = 5;                                        // from a point to the strip's corners
  constexpr std::size_t kRun = 256, kPiece = 16;                      // points of the curve
  struct Vertex {
    Eigen::Vector3d at;
    Eigen::Vector2d outward;
    double height = std::numeric_limits<double>::infinity();
  };
  std::vector<Vertex> run;
  std::vector<Eigen::AlignedBox3d> pieces;
  const auto finish = [&] {
    for (Eigen::AlignedBox3d& piece : pieces) piece = widened(piece, kReach * spacing);
    for_each_point_near(points, pieces, [&](const Eigen::Vector3d& point) {
      const Eigen::Vector3d at = plane(point);
      for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
        if (!pieces[piece].contains(point)) continue;
        for (std::size_t i = piece * kPiece; i < std::min((piece + 1) * kPiece, run.size()); ++i) {
          Vertex& v = run[i];
          const Eigen::Vector3d d = (at - v.at) / spacing;
          const double out = d.head<2>().dot(v.outward),
                       aside = d.x() * v.outward.y() - d.y() * v.outward.x(), height = std::abs(d.z());
          if (out >= kNear && out <= kFar && std::abs(aside) <= kAside && height <= kHigh)
            v.height = std::min(v.height, height);
        }
      }
    });
    for (const Vertex& v : run) visit(v.height);
    run.clear();
    pieces.clear();
  };
  for_each_with_neighbours(loop, scratch, [&](const auto& before, const auto& at, const auto& after) {
    if (run.size() % kPiece == 0) pieces.emplace_back();
    pieces.back().extend(at.position());
    const Eigen::Vector3d here = plane(at.position());
    const Eigen::Vector2d along = (plane(after.position()) - plane(before.position())).template head<2>();
    const Eigen::Vector3d to_surface(at.surface[0], at.surface[1], at.surface[2]);
    const Eigen::Vector2d inward = (plane(at.position() + to_surface) - here).template head<2>();
    Eigen::Vector2d outward = Eigen::Vector2d(along.y(), -along.x()).stableNormalized();
    if (outward.dot(inward) > 0) outward = -outward;
    run.push_back({here, outward});
    if (run.size() == kRun) finish();
  });
  finish();
}

// Whether the points of the curve are at one height, but for rounding: depth that is measured in steps.
bool is_slice(std::span<const LoopPoint> loop, const LoopPlane& plane, double radius, Scratch& scratch) {
  constexpr double kFlat = 0.004;  // standard deviation, of the radius
  double squares = 0;              // the mean is 0: the plane is through the centroid
  scratch.for_each(loop, [&](const LoopPoint& p) {
    const double height = plane(p.position()).z();
    squares += height * height;
  });
  return std::sqrt(squares / static_cast<double>(loop.size())) < kFlat * radius;
}

double radius_of(std::span<const LoopPoint> loop, const Eigen::Vector3d& middle, Scratch& scratch) {
  double most = 0;
  scratch.for_each(loop, [&](const LoopPoint& p) { most = std::max(most, (p.position() - middle).norm()); });
  return most;
}

}  // namespace

BeyondCurve beyond_curve(const TileStore& points, std::span<const LoopPoint> loop, const LoopShape& shape,
                         double radius, double spacing, Scratch& scratch) {
  constexpr double kSame = 0.5;  // spacings between heights of one surface
  if (!(shape.area > 0) || !std::isfinite(shape.area)) return {};
  const FlatLoop flat(loop, shape, scratch);
  const auto count = static_cast<double>(loop.size());
  double beyond = 0, level = 0;  // of the points
  for_each_height_beyond(points, loop, flat.plane, spacing, scratch, [&](double height) {
    beyond += std::isfinite(height);
    level += height <= kSame;
  });
  return {.goes_on = level / count,
          .layers = is_slice(loop, flat.plane, radius, scratch) ? beyond / count : 0,
          .volume = volume_over(points, loop, flat, radius, spacing, scratch)};
}

void rate_loops(const TileStore& points, Loops& loops, const Spill& spill, const Workers& workers) {
  for_each_loop(loops, spill, workers, [&](std::size_t i, std::span<const LoopPoint> loop, Scratch& scratch) {
    const LoopShape shape = shape_of(loop, scratch);
    LoopEvidence evidence = loops.evidence(i);
    evidence.width = 2 * shape.area / shape.perimeter / evidence.spacing;
    evidence.compactness = evidence.width / static_cast<double>(loop.size());
    evidence.kind = shape.kind;
    if (evidence.kind == LoopKind::kHole) {
      if (could_be_probable(evidence))
        evidence.prominence = prominence(points, loop, shape, evidence.spacing, scratch);
    } else {
      evidence.middle = {shape.centroid.x(), shape.centroid.y(), shape.centroid.z()};
      evidence.radius = radius_of(loop, shape.centroid, scratch);
      if (could_be_probable(evidence))
        evidence.beyond = beyond_curve(points, loop, shape, evidence.radius, evidence.spacing, scratch);
    }
    loops.set_evidence(i, evidence);
  });
}

}  // namespace lacuna
