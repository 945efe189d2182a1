// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/plan_raster.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace lacuna::io {
namespace {

// Calls visit(word, mask) for the words of the bits [from, to).
template <class Visit>
void for_each_word(std::size_t from, std::size_t to, const Visit& visit) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  for (std::size_t begin = from; begin < to;) {
    const std::size_t word = begin / 64, end = std::min(to, (word + 1) * 64);
    visit(word, (kAll >> (64 - (end - begin))) << begin % 64);
    begin = end;
  }
}

// Returns the first cell whose middle is at `at` or beyond, within [0, count].
std::size_t first_middle_from(double at, std::size_t count) {
  return static_cast<std::size_t>(std::clamp(std::ceil(at - 0.5), 0.0, static_cast<double>(count)));
}

// Adds the bits of `row`, moved by so many columns to the east, and to the west; fewer than 64.
void add_moved(std::span<const std::uint64_t> row, std::size_t columns, std::span<std::uint64_t> sum) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    sum[i] |= row[i] << columns | row[i] >> columns;
    if (columns == 0) continue;
    if (i > 0) sum[i] |= row[i - 1] >> (64 - columns);
    if (i + 1 < row.size()) sum[i] |= row[i + 1] << (64 - columns);
  }
}

// Calls visit(row, from, to) for the cells whose middles lie in a disc.
template <class Visit>
void for_each_row_of_disc(const Eigen::Vector2d& middle, double radius, const PlanRaster& raster,
                          const Visit& visit) {
  const std::size_t end = first_middle_from(middle.y() + radius, raster.rows());
  for (std::size_t row = first_middle_from(middle.y() - radius, raster.rows()); row < end; ++row) {
    const double dy = static_cast<double>(row) + 0.5 - middle.y();
    const double half = std::sqrt(std::max(radius * radius - dy * dy, 0.0));
    visit(row, first_middle_from(middle.x() - half, raster.columns()),
          first_middle_from(middle.x() + half, raster.columns()));
  }
}

using VisitRun = std::function<void(std::size_t row, std::size_t from, std::size_t to)>;
using Crossing = std::pair<std::size_t, double>;  // of a row's middle with an edge: row, place

// Returns the crossings of the rows [first, last); nothing where several rows have too many together.
std::optional<std::vector<Crossing>> crossings_of(const PlanPolygon& polygon, Frame frame,
                                                  const PlanGrid& grid, std::size_t first, std::size_t last) {
  constexpr std::size_t kMost = std::size_t{1} << 17;
  const auto to_cells = [&](const Eigen::Vector2d& corner) {
    return frame == Frame::kCells ? corner : grid.to_cells(corner);
  };
  std::vector<Crossing> crossings;
  for (const Ring2& ring : polygon) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d a = to_cells(ring[i]), b = to_cells(ring[i + 1 < ring.size() ? i + 1 : 0]);
      const std::size_t end = first_middle_from(std::max(a.y(), b.y()), last);
      for (std::size_t row = std::max(first, first_middle_from(std::min(a.y(), b.y()), last)); row < end;
           ++row) {
        const double y = static_cast<double>(row) + 0.5;
        crossings.emplace_back(row, a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
        if (crossings.size() > kMost && last - first > 1) return std::nullopt;
      }
    }
  }
  return crossings;
}

void visit_runs(const PlanPolygon& polygon, Frame frame, const PlanGrid& grid, std::size_t first,
                std::size_t last, const VisitRun& visit) {
  auto crossings = crossings_of(polygon, frame, grid, first, last);
  if (!crossings) {
    const std::size_t middle = first + (last - first) / 2;
    visit_runs(polygon, frame, grid, first, middle, visit);
    return visit_runs(polygon, frame, grid, middle, last, visit);
  }
  std::sort(crossings->begin(), crossings->end());
  for (std::size_t i = 0; i + 1 < crossings->size(); i += 2) {
    const std::size_t from = first_middle_from((*crossings)[i].second, grid.columns);
    const std::size_t to = first_middle_from((*crossings)[i + 1].second, grid.columns);
    if (from < to) visit((*crossings)[i].first, from, to);
  }
}

}  // namespace

PlanGrid PlanGrid::over(const Eigen::AlignedBox2d& box, double size) {
  PlanGrid grid{.size = size};
  const Eigen::Array2d end = grid.to_cells(box.max()).array().ceil();
  const Eigen::Array2d first = grid.to_cells(box.min()).array().floor();
  grid.first = first;
  grid.columns = static_cast<std::size_t>(end.x() - first.x());
  grid.rows = static_cast<std::size_t>(end.y() - first.y());
  return grid;
}

double area_of(const PlanPolygon& polygon) {
  double area = 0;
  for (std::size_t ring = 0; ring < polygon.size(); ++ring) {
    const Ring2& corners = polygon[ring];
    double twice = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
      twice += a.x() * b.y() - a.y() * b.x();
    }
    area += (ring == 0 ? 0.5 : -0.5) * std::fabs(twice);
  }
  return area;
}

void PlanRaster::set(std::size_t row, std::size_t from, std::size_t to) {
  std::uint64_t* const words = words_.data() + row * words_of_row_;
  for_each_word(from, to, [&](std::size_t word, std::uint64_t mask) { words[word] |= mask; });
}

void PlanRaster::clear(std::size_t row, std::size_t from, std::size_t to) {
  clear_bits({words_.data() + row * words_of_row_, words_of_row_}, from, to);
}

std::uint64_t PlanRaster::count() const {
  std::uint64_t count = 0;
  for (const std::uint64_t word : words_) count += static_cast<std::uint64_t>(std::popcount(word));
  return count;
}

std::uint64_t count_bits(std::span<const std::uint64_t> row, std::size_t from, std::size_t to) {
  std::uint64_t count = 0;
  for_each_word(from, to, [&](std::size_t word, std::uint64_t mask) {
    count += static_cast<std::uint64_t>(std::popcount(row[word] & mask));
  });
  return count;
}

void for_each_run(const PlanPolygon& polygon, Frame frame, const PlanGrid& grid, const VisitRun& visit) {
  visit_runs(polygon, frame, grid, 0, grid.rows, visit);
}

PlanRaster rasterise(std::span<const PlanPolygon> polygons, const PlanGrid& grid) {
  PlanRaster raster(grid);
  for (const PlanPolygon& polygon : polygons) {
    for_each_run(polygon, Frame::kScan, grid,
                 [&](std::size_t row, std::size_t from, std::size_t to) { raster.set(row, from, to); });
  }
  return raster;
}

void PlanRaster::fill() {
  for (std::size_t row = 0; row < rows(); ++row) set(row, 0, columns_);
}

void PlanRaster::subtract(const PlanRaster& other) {
  for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= ~other.words_[i];
}

void clear_disc(const Eigen::Vector2d& middle, double radius, PlanRaster& raster) {
  for_each_row_of_disc(middle, radius, raster, [&](std::size_t row, std::size_t from, std::size_t to) {
    raster.clear(row, from, to);
  });
}

bool has_in_disc(const Eigen::Vector2d& middle, double radius, const PlanRaster& raster) {
  bool has_any = false;
  for_each_row_of_disc(middle, radius, raster, [&](std::size_t row, std::size_t from, std::size_t to) {
    has_any = has_any || count_bits(raster.row(row), from, to) > 0;
  });
  return has_any;
}

void clear_bits(std::span<std::uint64_t> row, std::size_t from, std::size_t to) {
  for_each_word(from, to, [&](std::size_t word, std::uint64_t mask) { row[word] &= ~mask; });
}

void grow_row(const PlanGrid& grid, const CopyRow& copy, std::size_t row, double radius,
              std::span<std::uint64_t> grown) {
  std::vector<std::uint64_t> cells(grown.size());
  const auto reach = static_cast<std::ptrdiff_t>(radius);
  for (std::ptrdiff_t dy = -reach; dy <= reach; ++dy) {
    const std::ptrdiff_t other = static_cast<std::ptrdiff_t>(row) + dy;
    if (other < 0 || other >= static_cast<std::ptrdiff_t>(grid.rows)) continue;
    copy(static_cast<std::size_t>(other), cells);
    if (std::all_of(cells.begin(), cells.end(), [](std::uint64_t word) { return word == 0; })) continue;
    const auto half = static_cast<std::size_t>(std::sqrt(radius * radius - static_cast<double>(dy * dy)));
    for (std::size_t columns = 0; columns <= half; ++columns) add_moved(cells, columns, grown);
  }
}

namespace {

bool is_left_turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) > (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace

// Andrew's monotone chain: the lower chain from west to east, then the upper one back.
void ConvexHull::reduce() {
  const auto is_before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  };
  std::sort(points_.begin(), points_.end(), is_before);
  points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
  Ring2 hull;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t first = hull.size();
    for (auto point = begin; point != end; ++point) {
      while (hull.size() >= first + 2 && !is_left_turn(hull[hull.size() - 2], hull.back(), *point))
        hull.pop_back();
      hull.push_back(*point);
    }
    hull.pop_back();  // the first of the other chain
  };
  if (points_.size() > 2) {
    add_chain(points_.begin(), points_.end());
    add_chain(points_.rbegin(), points_.rend());
    points_ = std::move(hull);
  }
  kept_ = points_.size();
}

}  // namespace lacuna::io
