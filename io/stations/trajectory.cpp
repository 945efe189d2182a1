// SPDX-License-Identifier: Apache-2.0
#include "io/stations/trajectory.hpp"

#include "io/stations/direction_cells.hpp"
#include "io/stations/list_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace lacuna::io {
namespace {

constexpr std::size_t kSweptEdge = 64;        // cells of 1.8 degrees
constexpr double kPause = 10;                 // median intervals
constexpr std::uint64_t kBytesPerLine = 100;  // while a file is read
constexpr double kLeastShare = 0.02;  // of the largest count of a cell: others are of turns and rough ground

// Returns how many of the keys, in order, are `key` or less.
std::size_t count_up_to(const std::vector<double>& keys, double key) {
  return static_cast<std::size_t>(std::upper_bound(keys.begin(), keys.end(), key) - keys.begin());
}

// Interpolates the value at `key`, between the values of i - 1 and i.
template <class Value>
Value between(const std::vector<double>& keys, const std::vector<Value>& values, std::size_t i, double key) {
  const double share = (key - keys[i - 1]) / (keys[i] - keys[i - 1]);
  return values[i - 1] + share * (values[i] - values[i - 1]);
}

}  // namespace

Trajectory::Trajectory(std::vector<double> times, std::vector<Eigen::Vector3d> places)
    : times_(std::move(times)), lengths_(times_.size()), places_(std::move(places)) {
  for (std::size_t i = 1; i < places_.size(); ++i)
    lengths_[i] = lengths_[i - 1] + (places_[i] - places_[i - 1]).norm();
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times_.size(); ++i) intervals.push_back(times_[i] - times_[i - 1]);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  longest_interval_ = kPause * *middle;
  for (std::size_t i = 0; i < times_.size(); ++i)
    if (i == 0 || times_[i] - times_[i - 1] > longest_interval_) first_of_parts_.push_back(i);
  first_of_parts_.push_back(times_.size());
}

std::optional<double> Trajectory::length_at(double time) const {
  if (time == last_time()) return length();
  const std::size_t next = count_up_to(times_, time);
  if (next == 0 || next == times_.size()) return std::nullopt;
  const bool is_pause = times_[next] - times_[next - 1] > longest_interval_ && time > times_[next - 1];
  if (is_pause) return std::nullopt;
  return between(times_, lengths_, next, time);
}

Eigen::Vector3d Trajectory::place_at(double length) const {
  const std::size_t next = count_up_to(lengths_, length);
  if (next == 0) return places_.front();
  if (next == places_.size()) return places_.back();
  return between(lengths_, places_, next, length);
}

bool is_time(std::string_view column) {
  return column == "time" || column == "gps_time";
}

std::optional<Trajectory> read_trajectory(const std::filesystem::path& file, std::uint64_t memory) {
  ListLines lines(file, "numbers are needed in the columns time, x, y and z");
  std::optional<Fields> fields = lines.next();
  const std::vector<std::string>& header = lines.header();
  const auto time = std::find_if(header.begin(), header.end(), is_time);
  if (time == header.end()) return std::nullopt;
  std::array<std::size_t, 4> columns{static_cast<std::size_t>(time - header.begin())};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const auto column = std::find(header.begin(), header.end(), name);
    if (column == header.end())
      lines.in().fail("has a column " + *time + ", but none that is named " + name +
                      "; a trajectory has time, x, y and z");
    columns[axis + 1] = static_cast<std::size_t>(column - header.begin());
  }
  std::vector<std::pair<double, Eigen::Vector3d>> records;
  for (; fields; fields = lines.next()) {
    std::array<double, 4> values;
    for (std::size_t i = 0; i < 4; ++i) {
      if (columns[i] >= fields->size()) lines.fail("has " + std::to_string(fields->size()) + " columns");
      values[i] = lines.parse((*fields)[columns[i]]);
    }
    if (records.size() >= memory / kBytesPerLine)
      lines.in().fail(
          "has more than the " + std::to_string(records.size()) +
          " lines that the memory limit has space for; allowed: fewer lines, such as 100 for each "
          "second, or a larger --memory-limit");
    records.emplace_back(values[0], Eigen::Vector3d(values[1], values[2], values[3]));
  }
  const auto is_earlier = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::stable_sort(records.begin(), records.end(), is_earlier);
  std::vector<double> times;
  std::vector<Eigen::Vector3d> places;
  for (const auto& [at, place] : records) {
    if (!times.empty() && at == times.back()) continue;
    times.push_back(at);
    places.push_back(place);
  }
  if (times.size() < 2) lines.in().fail("has fewer than two times; a trajectory has two or more");
  return Trajectory(std::move(times), std::move(places));
}

Eigen::Matrix3d Trajectory::axes_at(double length, double reach) const {
  const auto part = std::upper_bound(first_of_parts_.begin() + 1, first_of_parts_.end() - 1, length,
                                     [&](double at, std::size_t first) { return at < lengths_[first]; });
  const double least = lengths_[*(part - 1)], most = lengths_[*part - 1];
  const Eigen::Vector3d chord =
      place_at(std::min(length + reach, most)) - place_at(std::max(length - reach, least));
  const double level = std::sqrt(chord.x() * chord.x() + chord.y() * chord.y());
  Eigen::Matrix3d axes;
  const Eigen::Vector3d forward =
      chord.squaredNorm() > 0 ? Eigen::Vector3d(chord.normalized()) : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d left =
      level > 0 ? Eigen::Vector3d(-chord.y() / level, chord.x() / level, 0) : Eigen::Vector3d::UnitY();
  axes << forward.transpose(), left.transpose(), forward.cross(left).transpose();
  return axes;
}

SweptDirections::SweptDirections() : counts_(6 * kSweptEdge * kSweptEdge) {}

void SweptDirections::add(const Eigen::Vector3d& direction) {
  ++counts_[cell_of(direction, kSweptEdge)];
}

void SweptDirections::finish() {
  const auto most = static_cast<double>(*std::max_element(counts_.begin(), counts_.end()));
  is_swept_.resize(counts_.size());
  for (std::size_t i = 0; i < counts_.size(); ++i) is_swept_[i] = counts_[i] > kLeastShare * most;
}

bool SweptDirections::contains(const Eigen::Vector3d& direction) const {
  return is_swept_[cell_of(direction, kSweptEdge)];
}

}  // namespace lacuna::io
