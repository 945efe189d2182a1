// SPDX-License-Identifier: Apache-2.0
#include "io/stations/find_station.hpp"

#include "engine/model/points.hpp"
#include "engine/run/error.hpp"
#include "io/stations/station.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <utility>

#include <Eigen/Geometry>

namespace lacuna::io {
namespace {

constexpr double kJump = 10;         // over the distances before and after
constexpr std::size_t kLeast = 100;  // jumps
constexpr std::size_t kDrawn = 1000, kCompared = 512;
constexpr double kSame = 0.5;  // relative difference of equal steps

// Returns the sine of the angle between two points at a place; 0 if the place is one of them.
double step_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& eye) {
  const Eigen::Vector3d to_a = a - eye, to_b = b - eye;
  const double lengths = to_a.norm() * to_b.norm();
  return lengths > 0 ? to_a.cross(to_b).norm() / lengths : 0;
}

// Returns how much the steps before, across and after the jump differ: 0 to 1.
double difference(const Jump& jump, const Eigen::Vector3d& eye) {
  const auto [least, most] =
      std::minmax({step_between(jump[0], jump[1], eye), step_between(jump[1], jump[2], eye),
                   step_between(jump[2], jump[3], eye)});
  return most > 0 ? 1 - least / most : 1;
}

double mean_difference(std::span<const Jump> jumps, const Eigen::Vector3d& eye) {
  double sum = 0;
  for (const Jump& jump : jumps) sum += difference(jump, eye);
  return sum / static_cast<double>(jumps.size());
}

// Returns the middle between two lines, where they are nearest; nothing if they are nearly parallel.
std::optional<Eigen::Vector3d> meeting_of(const Jump& a, const Jump& b) {
  const Eigen::Vector3d u = (a[2] - a[1]).normalized(), v = (b[2] - b[1]).normalized(), arm = b[1] - a[1];
  const double cosine = u.dot(v), square = 1 - cosine * cosine;
  if (!(square > 0.05)) return std::nullopt;
  const double s = (arm.dot(u) - arm.dot(v) * cosine) / square;
  const double t = (arm.dot(u) * cosine - arm.dot(v)) / square;
  return 0.5 * (a[1] + s * u + b[1] + t * v);
}

// Takes steps along the axes, ever shorter, as long as they make the difference smaller.
Eigen::Vector3d refine(std::span<const Jump> jumps, Eigen::Vector3d eye, double step) {
  double least = mean_difference(jumps, eye);
  for (const double shortest = step / 4096; step > shortest;) {
    bool is_better = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {step, -step}) {
        Eigen::Vector3d other = eye;
        other[axis] += side;
        const double there = mean_difference(jumps, other);
        if (there >= least) continue;
        least = there;
        eye = other;
        is_better = true;
      }
    }
    if (!is_better) step /= 2;
  }
  return eye;
}

struct SweepReader final : RowObserver {
  std::map<std::pair<std::size_t, std::optional<std::uint32_t>>, Sweep> sweeps;  // by file and scanner

  void take(std::size_t file, const ScanReader& reader, const RowBatch& rows,
            std::span<const Eigen::Vector3d>, std::span<const Eigen::Vector3d> kept) override {
    const std::vector<double> sources = sources_of(rows, reader.layout());
    for (std::size_t i = 0; i < rows.count; ++i) {
      std::optional<std::uint32_t> source;
      if (!sources.empty() && sources[i] >= 0 && sources[i] < 0x1p32)
        source = static_cast<std::uint32_t>(sources[i]);
      Sweep& sweep = sweeps.try_emplace({file, source}, Sweep{file, source, {}}).first->second;
      if (sweeps.size() > kMostSweeps)
        throw Error("the scans have more than " + std::to_string(kMostSweeps) +
                    " numbers of scanners, so they are not single sweeps");
      sweep.jumps.add(kept[i]);
    }
  }
};

}  // namespace

void Jumps::add(const Eigen::Vector3d& position) {
  if (!position.allFinite()) {
    known_ = 0;
    return;
  }
  std::rotate(last_.begin(), last_.begin() + 1, last_.end());
  last_[3] = position;
  known_ = std::min<std::size_t>(known_ + 1, 4);
  if (known_ < 4) return;
  const double before = (last_[1] - last_[0]).norm(), after = (last_[3] - last_[2]).norm();
  const bool is_jump =
      before > 0 && after > 0 && (last_[2] - last_[1]).norm() > kJump * std::max(before, after);
  if (!is_jump || seen_++ % stride_ != 0) return;
  kept_.push_back(last_);
  if (kept_.size() < kMost) return;
  for (std::size_t i = 0; 2 * i < kept_.size(); ++i) kept_[i] = kept_[2 * i];
  kept_.resize(kMost / 2);
  stride_ *= 2;
}

std::optional<FoundStation> find_station(std::span<const Jump> jumps) {
  if (jumps.size() < kLeast) return std::nullopt;
  std::minstd_rand random(1);
  std::vector<Jump> compared;
  for (std::size_t i = 0; i < std::min(kCompared, jumps.size()); ++i)
    compared.push_back(jumps[i * jumps.size() / std::min(kCompared, jumps.size())]);
  std::optional<Eigen::Vector3d> best;
  double least = 1;
  for (std::size_t i = 0; i < kDrawn; ++i) {
    const Jump& a = jumps[random() % jumps.size()];
    const Jump& b = jumps[random() % jumps.size()];
    const std::optional<Eigen::Vector3d> eye = meeting_of(a, b);
    if (!eye) continue;
    const double there = mean_difference(compared, *eye);
    if (there >= least) continue;
    least = there;
    best = eye;
  }
  if (!best) return std::nullopt;
  double range = 0;
  for (const Jump& jump : compared) range += (jump[1] - *best).norm() / static_cast<double>(compared.size());
  const Eigen::Vector3d place = refine(jumps, *best, 0.1 * range);
  const auto same = std::count_if(jumps.begin(), jumps.end(),
                                  [&](const Jump& jump) { return difference(jump, place) <= kSame; });
  return FoundStation{place, static_cast<double>(same) / static_cast<double>(jumps.size())};
}

std::vector<Sweep> read_sweeps(const ScanFiles& scan) {
  SweepReader reader;
  read_all(scan, reader);
  std::vector<Sweep> sweeps;
  for (auto& [key, sweep] : reader.sweeps) sweeps.push_back(std::move(sweep));
  return sweeps;
}

}  // namespace lacuna::io
