// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/own_frames.hpp"

#include "io/explain/stations/direction_cells.hpp"

#include <algorithm>
#include <vector>

namespace lacuna::io {
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
