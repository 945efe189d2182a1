// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/cause.hpp"
#include "io/explain/stations/station_views.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace lacuna::io {
namespace {

constexpr std::size_t kMostPoints = 100'000;
constexpr double kColumnEdge = 2;     // of a column, in spacings of a square grid
constexpr double kEnd = 0.5;          // height of the end of a column, in edges
constexpr float kLevelCosine = 0.9F;  // cosine between a normal and the axis
constexpr double kEnclosed = 0.5;   // share of the columns with two level ends, as between floor and ceiling
constexpr double kSignificant = 3;  // standard deviations of a difference of counts
constexpr double kTwice = 2;

struct ColumnPoint {
  std::int64_t row, column;
  double height;
  bool is_level;
};

// The columns along an axis that are higher than wide, by their ends.
struct Columns {
  std::uint64_t all = 0, level = 0;           // columns; points that are level
  std::uint64_t low = 0, high = 0, both = 0;  // columns whose lower, upper, both ends are level

  bool are_enclosed() const {
    return all > 0 && static_cast<double>(both) > kEnclosed * static_cast<double>(all);
  }
  // Returns how much the columns speak for the direction of the axis as up; below 0, for its opposite.
  double evidence() const {
    const auto up = static_cast<double>(low), down = static_cast<double>(high);
    const double difference = are_enclosed() ? down - up : up - down;
    const bool is_clear = std::abs(difference) > kSignificant * std::sqrt(up + down) &&
                          std::max(up, down) >= kTwice * std::min(up, down);
    return is_clear ? difference : 0;
  }
};

bool is_level(std::span<const ColumnPoint> end) {
  return 2 * std::ranges::count_if(end, &ColumnPoint::is_level) >= std::ssize(end);
}

// `column`: by height.
void count_column(std::span<const ColumnPoint> column, double edge, Columns& columns) {
  if (column.back().height - column.front().height < edge) return;
  const auto lower_end =
      std::ranges::upper_bound(column, column.front().height + kEnd * edge, {}, &ColumnPoint::height);
  const auto upper_end =
      std::ranges::lower_bound(column, column.back().height - kEnd * edge, {}, &ColumnPoint::height);
  const bool low = is_level({column.begin(), lower_end}), high = is_level({upper_end, column.end()});
  ++columns.all;
  columns.low += low && !high ? 1 : 0;
  columns.high += high && !low ? 1 : 0;
  columns.both += low && high ? 1 : 0;
}

Columns columns_along(Eigen::Index axis, std::span<const Eigen::Vector3d> points,
                      std::span<const Eigen::Vector3f> normals, std::size_t step, double edge) {
  std::vector<ColumnPoint> sorted;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Eigen::Vector3d from_first = points[i] - points.front();
    sorted.push_back({static_cast<std::int64_t>(std::floor(from_first[(axis + 1) % 3] / edge)),
                      static_cast<std::int64_t>(std::floor(from_first[(axis + 2) % 3] / edge)),
                      from_first[axis], std::abs(normals[i][axis]) >= kLevelCosine});
  }
  Columns columns;
  columns.level = static_cast<std::uint64_t>(std::ranges::count_if(sorted, &ColumnPoint::is_level));
  const auto place = [](const ColumnPoint& point) { return std::tie(point.row, point.column, point.height); };
  std::ranges::sort(sorted, {}, place);
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto last = std::find_if(first, sorted.end(), [&](const ColumnPoint& point) {
      return point.row != first->row || point.column != first->column;
    });
    count_column({first, last}, edge, columns);
    first = last;
  }
  return columns;
}

}  // namespace

std::optional<Upward> other_upward(std::span<const Eigen::Vector3d> points,
                                   std::span<const Eigen::Vector3f> normals, double area) {
  const std::size_t step = points.size() / kMostPoints + 1;
  const double edge =
      kColumnEdge * std::sqrt(area * static_cast<double>(step) / static_cast<double>(points.size()));
  if (points.empty() || !(edge > 0) || !std::isfinite(edge)) return std::nullopt;
  std::array<Columns, 3> along;
  Upward upward;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    Columns& columns = along[static_cast<std::size_t>(axis)];
    columns = columns_along(axis, points, normals, step, edge);
    upward.level[static_cast<std::size_t>(axis)] = columns.level;
  }
  const Columns& z = along[2];
  for (const Eigen::Index axis : {0, 1})
    if (along[static_cast<std::size_t>(axis)].level > along[static_cast<std::size_t>(upward.axis)].level)
      upward.axis = axis;
  const Columns& most = along[static_cast<std::size_t>(upward.axis)];
  const double evidence = most.evidence();
  upward.is_known = evidence != 0;
  upward.is_down = evidence < 0;
  if (upward.axis == 2) return upward.is_down ? std::optional(upward) : std::nullopt;
  // Walls may have most points. They are no floors where the columns of z say that it is up.
  const bool is_much_more = static_cast<double>(most.level) > kTwice * static_cast<double>(z.level);
  const bool is_box = evidence == 0 && z.evidence() == 0 && most.are_enclosed() && z.are_enclosed();
  const double needed = is_much_more ? 1 : kTwice;
  const bool is_other = std::abs(evidence) > needed * std::max(0.0, z.evidence()) ||
                        (is_much_more && (z.evidence() < 0 || is_box));
  return is_other ? std::optional(upward) : std::nullopt;
}

namespace {

constexpr std::size_t kMostFiles = 8;
constexpr std::size_t kSphereEdge = 64;   // cells of 1.8 degrees
constexpr float kOther = 1.2F;            // ratio of ranges of two surfaces
constexpr double kMostConflicts = 0.2;    // of the cells with several points
constexpr double kLeastShared = 0.5;      // of the cells of the smaller file
constexpr double kLeastDifferent = 0.3;   // of the shared cells
constexpr std::size_t kLeastCells = 500;  // that are shared

// The ranges in each direction from 0 0 0.
struct FileRanges {
  struct Cell {
    float nearest = 0, farthest = 0;
    std::uint32_t points = 0;
  };
  std::vector<Cell> cells = std::vector<Cell>(6 * kSphereEdge * kSphereEdge);

  void add(const Eigen::Vector3d& position) {
    const auto range = static_cast<float>(position.norm());
    if (!(range > 0)) return;
    Cell& cell = cells[cell_of(position, kSphereEdge)];
    cell.nearest = cell.points == 0 ? range : std::min(cell.nearest, range);
    cell.farthest = std::max(cell.farthest, range);
    ++cell.points;
  }

  std::size_t filled() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(cells, [](const Cell& cell) { return cell.points > 0; }));
  }
  bool is_of_one_scanner() const {
    const auto several = std::ranges::count_if(cells, [](const Cell& cell) { return cell.points > 1; });
    const auto conflicts =
        std::ranges::count_if(cells, [](const Cell& cell) { return cell.farthest > kOther * cell.nearest; });
    return several > 0 && static_cast<double>(conflicts) < kMostConflicts * static_cast<double>(several);
  }
};

bool are_different(const FileRanges& a, const FileRanges& b) {
  std::size_t shared = 0, different = 0;
  for (std::size_t i = 0; i < a.cells.size(); ++i) {
    const FileRanges::Cell &of_a = a.cells[i], &of_b = b.cells[i];
    if (of_a.points == 0 || of_b.points == 0) continue;
    ++shared;
    different += of_a.nearest > kOther * of_b.farthest || of_b.nearest > kOther * of_a.farthest ? 1 : 0;
  }
  const auto smaller = static_cast<double>(std::min(a.filled(), b.filled()));
  return shared >= kLeastCells && static_cast<double>(shared) >= kLeastShared * smaller &&
         static_cast<double>(different) >= kLeastDifferent * static_cast<double>(shared);
}

}  // namespace

std::optional<std::pair<std::size_t, std::size_t>> own_frames(const Detection& detection,
                                                              std::span<const std::uint64_t> ends) {
  if (ends.size() < 2) return std::nullopt;
  std::vector<FileRanges> files(std::min(ends.size(), kMostFiles));
  detection.for_each_sampled_point([&](const SampledPoint& point) {
    const auto file =
        static_cast<std::size_t>(std::ranges::upper_bound(ends, value(point.id)) - ends.begin());
    if (file < files.size()) files[file].add(point.position());
  });
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!files[i].is_of_one_scanner()) continue;
    for (std::size_t j = i + 1; j < files.size(); ++j)
      if (files[j].is_of_one_scanner() && are_different(files[i], files[j])) return std::pair(i, j);
  }
  return std::nullopt;
}

}  // namespace lacuna::io
