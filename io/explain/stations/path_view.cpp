// SPDX-License-Identifier: Apache-2.0
// What a scanner saw from each section of its path, and the cells of directions.
#include "engine/run/error.hpp"
#include "engine/store/store_file.hpp"
#include "io/explain/stations/station_views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <spdlog/fmt/fmt.h>
#include <sys/mman.h>

namespace lacuna::io {

std::size_t cell_of(const Eigen::Vector3d& direction, std::size_t edge) {
  const double x = std::fabs(direction.x()), y = std::fabs(direction.y()), z = std::fabs(direction.z());
  const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  const double half = static_cast<double>(edge) / 2;
  const double along = std::fabs(direction[axis]);
  const auto place = [&](int other) {
    return std::min(edge - 1, static_cast<std::size_t>((direction[other] / along + 1) * half));
  };
  const std::size_t face = static_cast<std::size_t>(2 * axis) + (direction[axis] < 0 ? 1 : 0);
  return (face * edge + place((axis + 1) % 3)) * edge + place((axis + 2) % 3);
}

Eigen::Vector3d direction_of(std::size_t cell, std::size_t edge) {
  const std::size_t face = cell / (edge * edge);
  const auto place = [&](std::size_t index) {
    return (2 * static_cast<double>(index) + 1) / static_cast<double>(edge) - 1;
  };
  const int axis = static_cast<int>(face / 2);
  Eigen::Vector3d direction;
  direction[axis] = face % 2 == 0 ? 1 : -1;
  direction[(axis + 1) % 3] = place(cell / edge % edge);
  direction[(axis + 2) % 3] = place(cell % edge);
  return direction.normalized();
}

double RaySpread::angle() const {
  const double mean = sum_.norm() / static_cast<double>(std::max<std::uint64_t>(count_, 1));
  return std::sqrt(std::max(0.0, 2 * (1 - mean)));
}

bool RaySpread::is_narrow() const {
  constexpr double kNarrow = 0.07;
  constexpr std::uint64_t kFewRays = 100;
  return count_ >= kFewRays && angle() < kNarrow;
}

FieldOfView::FieldOfView(const Eigen::Vector3d& axis)
    : axis_(axis), right_(axis.unitOrthogonal()), forward_(axis.cross(right_)) {}

// Uses the sums of components. An arc tangent differs between machines.
std::size_t FieldOfView::bin_of(const Eigen::Vector3d& direction) const {
  const double x = direction.dot(right_), y = direction.dot(forward_);
  const double sum = std::fabs(x) + std::fabs(y);
  if (sum == 0) return 0;
  const double quarter = y >= 0 ? 1 - x / sum : 3 + x / sum;  // from 0 to 4
  const double quarters = static_cast<double>(bins_.size()) / 4;
  return std::min(static_cast<std::size_t>(quarter * quarters), bins_.size() - 1);
}

void FieldOfView::add(const Eigen::Vector3d& direction) {
  const double sine = direction.dot(axis_);
  lowest_ = std::min(lowest_, sine);
  highest_ = std::max(highest_, sine);
  bins_[bin_of(direction)] = true;
}

bool FieldOfView::contains(const Eigen::Vector3d& direction) const {
  const double sine = direction.dot(axis_);
  return sine >= lowest_ && sine <= highest_ && bins_[bin_of(direction)];
}

double FieldOfView::turn() const {
  return static_cast<double>(bins_.count()) / static_cast<double>(bins_.size());
}

void RangeImage::Unmap::operator()(float* cells) const {
  ::munmap(cells, kBytes);
}

RangeImage::RangeImage(const std::filesystem::path& folder)
    : cells_(reinterpret_cast<float*>(StoreFile(folder / "range-image").map(kBytes))) {}

double RangeImage::put(const Eigen::Vector3d& direction, double range) {
  float& cell = cells_[cell_of(direction, kEdge)];
  const float before = cell, rounded = static_cast<float>(range);
  if (before == 0 || rounded < before) cell = rounded;
  return before;
}

// Makes two passes over the offsets to the nearest cell (Danielsson, *Euclidean distance mapping*, 1980).
void RangeImage::fill(std::size_t distance) {
  struct Offset {
    std::int16_t row, column;
    int square() const { return row * row + column * column; }
  };
  constexpr Offset kNone{10'000, 10'000};
  constexpr auto kRow = static_cast<std::ptrdiff_t>(kEdge);
  std::vector<Offset> offsets(kEdge * kEdge);
  for (std::size_t face = 0; face < 6; ++face) {
    float* const cells = cells_.get() + face * kEdge * kEdge;
    for (std::size_t i = 0; i < offsets.size(); ++i) offsets[i] = cells[i] > 0 ? Offset{0, 0} : kNone;
    const auto take = [&](std::ptrdiff_t at, std::ptrdiff_t row, std::ptrdiff_t column) {
      const Offset& other = offsets[static_cast<std::size_t>(at + row * kRow + column)];
      const Offset through{static_cast<std::int16_t>(other.row + row),
                           static_cast<std::int16_t>(other.column + column)};
      Offset& own = offsets[static_cast<std::size_t>(at)];
      if (through.square() < own.square()) own = through;
    };
    for (const int step : {1, -1}) {
      for (std::ptrdiff_t r = 0; r < kRow; ++r) {
        const std::ptrdiff_t row = step > 0 ? r : kRow - 1 - r;
        if (r > 0)
          for (std::ptrdiff_t column = 0; column < kRow; ++column) take(row * kRow + column, -step, 0);
        for (std::ptrdiff_t column = 1; column < kRow; ++column) take(row * kRow + column, 0, -1);
        for (std::ptrdiff_t column = kRow - 1; column-- > 0;) take(row * kRow + column, 0, 1);
      }
    }
    const int most = static_cast<int>(distance * distance);
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      const Offset& offset = offsets[i];
      if (cells[i] == 0 && offset.square() <= most)
        cells[i] = cells[static_cast<std::ptrdiff_t>(i) + offset.row * kRow + offset.column];
    }
  }
}

std::array<std::size_t, kCoarserImages> count_filled(const RangeImage& image) {
  std::vector<bool> has_range(RangeImage::kCells);
  for (std::size_t i = 0; i < has_range.size(); ++i) has_range[i] = image.cells()[i] > 0;
  std::array<std::size_t, kCoarserImages> counts{};
  for (std::size_t level = 0, edge = RangeImage::kEdge; level < counts.size(); ++level, edge /= 2) {
    counts[level] = static_cast<std::size_t>(std::count(has_range.begin(), has_range.end(), true));
    std::vector<bool> coarser(has_range.size() / 4);
    for (std::size_t i = 0; i < has_range.size(); ++i)
      if (has_range[i]) coarser[i / edge / 2 * (edge / 2) + i % edge / 2] = true;
    has_range.swap(coarser);
  }
  return counts;
}

void RangeImage::leave_memory() const {
  ::madvise(cells_.get(), kBytes, MADV_DONTNEED);
}

namespace {

constexpr double kFinest = 0.02;           // metres, of a section
constexpr double kMostSections = 1 << 18;  // each takes 104 bytes of memory
constexpr double kSections = 100;          // in the mean range
constexpr double kChord = 0.5;             // metres before and after a place, for its axes
constexpr double kOffset = 0.382;          // of borders of sections: scanners turn at whole lengths
constexpr std::size_t kFiner = 9;          // parts of a cell's edge in which ranges are compared
constexpr std::uint32_t kParts = kFiner * kFiner;
constexpr std::uint32_t kCells = 6 * PathView::kEdge * PathView::kEdge;
constexpr std::uint32_t kGroup = 8;  // sections: profiles lie closer than a 12th of the range
constexpr std::ptrdiff_t kGap = 2;   // cells between rays
constexpr std::ptrdiff_t kNothing = kGap * kGap + 1;

// Returns the part of its cell in which a direction is.
std::uint32_t part_of(const Eigen::Vector3d& direction) {
  const std::size_t finer = cell_of(direction, PathView::kEdge * kFiner);
  const std::size_t row = finer / (PathView::kEdge * kFiner), column = finer;
  return static_cast<std::uint32_t>(row % kFiner * kFiner + column % kFiner);
}

}  // namespace

PathView::PathView(Trajectory path, std::filesystem::path stated, double metre, std::filesystem::path folder,
                   std::uint64_t memory)
    : path_(std::move(path)),
      stated_(std::move(stated)),
      folder_(std::move(folder)),
      memory_(memory),
      finest_(std::max(kFinest * metre, path_.length() / kMostSections)),
      section_(finest_),
      chord_(kChord * metre) {
  begin();
}

void PathView::begin() {
  rays_.emplace(folder_ / "path-rays", memory_ / 4);
  swept_ = {};
  spread_ = {};
  field_ = FieldOfView(Eigen::Vector3d::UnitZ());
  points_ = placed_ = range_sum_ = 0;
  first_time_ = time_step_ = std::numeric_limits<double>::infinity();
  last_time_ = -first_time_;
  previous_time_ = std::numeric_limits<double>::quiet_NaN();
  farthest_ = 0;
}

void PathView::add(double time, const Eigen::Vector3d& position, bool is_kept) {
  if (!position.allFinite()) return;
  ++points_;
  if (time != previous_time_) time_step_ = std::fmin(time_step_, std::fabs(time - previous_time_));
  previous_time_ = time;
  first_time_ = std::fmin(first_time_, time);
  last_time_ = std::fmax(last_time_, time);
  const std::optional<double> length = path_.length_at(time);
  if (!length) return;
  const Eigen::Vector3d arm = position - path_.place_at(*length);
  const double range = arm.norm();
  if (!(range > 0)) return;
  const auto section = static_cast<std::uint32_t>(*length / finest_ + kOffset);
  if (section != last_section_) {
    last_section_ = section;
    last_axes_ = path_.axes_at((section + 0.5 - kOffset) * finest_, chord_);
  }
  const Eigen::Vector3d in_axes = last_axes_ * arm;
  swept_.add(in_axes);
  field_.add(arm / range);
  spread_.add(arm / range);
  farthest_ = std::max(farthest_, range);
  range_sum_ += static_cast<std::uint64_t>(std::min(range / finest_, 1e9));
  ++placed_;
  const auto cell = static_cast<std::uint32_t>(cell_of(in_axes, kEdge));
  rays_->add(
      {section, (is_kept ? cell : kCells + cell) * kParts + part_of(in_axes), static_cast<float>(range)});
}

void PathView::complete() {
  if (placed_ == 0)
    throw Error(
        fmt::format("{}: has no place at the times of the points, which are {:.12g} to {:.12g}; the "
                    "trajectory has {:.12g} to {:.12g}",
                    stated_.string(), first_time_, last_time_, path_.first_time(), path_.last_time()));
  swept_.finish();
  const auto finest = std::max<std::uint64_t>(
      1, static_cast<std::uint64_t>(static_cast<double>(range_sum_ / placed_) / kSections));
  section_ = static_cast<double>(finest) * finest_;
  Rays sections(folder_ / "path-sections", memory_ / 4);
  rays_->for_each([&](const Ray& ray) {
    sections.add({static_cast<std::uint32_t>(ray.section / finest), ray.cell, ray.range});
  });
  rays_.reset();
  store(sections);
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) {
    const double middle = (static_cast<double>(i) + 0.5) * section_ - kOffset * finest_;
    eyes_.push_back(path_.place_at(middle));
    axes_.push_back(path_.axes_at(middle, chord_));
  }
}

// Keeps the nearest range of each cell. Counts the points that lie behind others in their part of a cell.
void PathView::store(Rays& rays) {
  const auto for_each_nearest = [&](auto&& visit) {
    std::optional<Ray> nearest, first;  // of a cell, and of a part
    conflicts_ = 0;
    rays.for_each([&](const Ray& ray) {
      if (!first || first->section != ray.section || first->cell != ray.cell) first = ray;
      if (ray.range > (1 + kConflict) * first->range) ++conflicts_;
      const Ray whole{ray.section, ray.cell / kParts, ray.range};
      const bool is_same = nearest && nearest->section == whole.section && nearest->cell == whole.cell;
      if (nearest && !is_same) visit(*nearest);
      if (!is_same || whole.range < nearest->range) nearest = whole;
    });
    if (nearest) visit(*nearest);
  };
  // One more than whole sections: the quotients of a length are rounded.
  first_.assign(static_cast<std::size_t>(path_.length() / section_) + 3, 0);
  for_each_nearest([&](const Ray& ray) { ++first_[ray.section + 1]; });
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  const std::uint64_t bytes = first_.back() * sizeof(Entry);
  auto* const mapped = reinterpret_cast<Entry*>(StoreFile(folder_ / "path-ranges").map(bytes));
  entries_ = {mapped, Unmap{bytes}};
  std::uint64_t at = 0;
  for_each_nearest([&](const Ray& ray) { entries_[at++] = {ray.cell, ray.range}; });
}

StationSummary PathView::summary() const {
  return {.name = stated_.stem().string(),
          .place = path_.place_at(path_.length() / 2),
          .path = path_.length(),
          .left_out = path_.left_out(),
          .points = placed_,
          .untimed = points_ - placed_,
          .coarse_step = coarse_step(),
          .certainty = certainty(),
          .spread = spread_.angle(),
          .lowest = field_.lowest(),
          .highest = field_.highest(),
          .turn = field_.turn(),
          .farthest = farthest_};
}

double PathView::certainty() const {
  if (spread_.is_narrow() || std::isinf(time_step_)) return 0;
  return static_cast<double>(placed_ - conflicts_) / static_cast<double>(points_);
}

// Returns the step of the points' times if the scanner moves farther in it than two sections; else 0.
double PathView::coarse_step() const {
  const double speed = path_.length() / (path_.last_time() - path_.first_time());
  return time_step_ * speed > 2 * section_ ? time_step_ : 0;
}

std::vector<std::uint32_t> PathView::sections_near(const Eigen::AlignedBox3d& box, double range) const {
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    if (first_[i] < first_[i + 1] && box.squaredExteriorDistance(eyes_[i]) <= range * range)
      near.push_back(static_cast<std::uint32_t>(i));
  }
  return near;
}

std::vector<Aim> PathView::aims_at(const Eigen::Vector3d& place,
                                   std::span<const std::uint32_t> sections) const {
  std::vector<Aim> aims;
  std::uint32_t first = 0;  // of a group
  std::ptrdiff_t least = 0;
  for (const std::uint32_t section : sections) {
    const Eigen::Vector3d arm = place - eyes_[section];
    const Eigen::Vector3d in_axes = axes_[section] * arm;
    if (!swept_.contains(in_axes)) continue;
    const double range = arm.norm();
    const std::size_t cell = cell_of(in_axes, kEdge);
    std::ptrdiff_t off = kNothing;
    const Aim aim{.eye = eyes_[section],
                  .direction = arm / range,
                  .range = range,
                  .measured = range_near(section, cell, false, off),
                  .left_out = range_near(section, cell, true, off)};
    if (aims.empty() || section >= first + kGroup) {
      first = section;
      aims.push_back(aim);
    } else if (off < least) {
      aims.back() = aim;
    } else {
      continue;
    }
    least = off;
  }
  return aims;
}

// Returns the range of the nearest cell with one, within kGap. Among equally near cells, the first counts.
// `off` becomes the square of the cell's distance, if that is less.
double PathView::range_near(std::uint32_t section, std::size_t cell, bool is_left_out,
                            std::ptrdiff_t& off) const {
  constexpr auto kRow = static_cast<std::ptrdiff_t>(kEdge);
  const std::size_t face = cell / (kEdge * kEdge);
  const auto row = static_cast<std::ptrdiff_t>(cell / kEdge % kEdge);
  const auto column = static_cast<std::ptrdiff_t>(cell % kEdge);
  const Entry* const end = entries_.get() + first_[section + 1];
  const Entry* at = entries_.get() + first_[section];
  double nearest = 0;
  std::ptrdiff_t least = kNothing;
  for (std::ptrdiff_t r = std::max<std::ptrdiff_t>(row - kGap, 0); r <= std::min(row + kGap, kRow - 1); ++r) {
    const auto first_of_row = static_cast<std::uint32_t>((is_left_out ? kCells : 0) + face * kEdge * kEdge +
                                                         static_cast<std::size_t>(r * kRow));
    const auto from = first_of_row + static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(column - kGap, 0));
    const auto to = first_of_row + static_cast<std::uint32_t>(std::min(column + kGap, kRow - 1));
    at = std::lower_bound(at, end, from, [](const Entry& a, std::uint32_t b) { return a.cell < b; });
    for (; at != end && at->cell <= to; ++at) {
      const std::ptrdiff_t across = static_cast<std::ptrdiff_t>(at->cell - first_of_row) - column;
      const std::ptrdiff_t square = (r - row) * (r - row) + across * across;
      if (square >= least) continue;
      least = square;
      nearest = at->range;
    }
  }
  off = std::min(off, least);
  return nearest;
}

void PathView::Unmap::operator()(Entry* entries) const {
  ::munmap(entries, bytes);
}

void PathView::leave_memory() const {
  ::madvise(entries_.get(), bytes(), MADV_DONTNEED);
}

}  // namespace lacuna::io
