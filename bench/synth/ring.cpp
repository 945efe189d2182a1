// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/ring.hpp"

#include <cmath>
#include <cstddef>
#include <unordered_map>

namespace lacuna::synth {

namespace {

constexpr double kFirstStep = 0.25;  // nodes; ends of a step with one nearest point have it in between, too
constexpr double kLastStep = 0x1p-20;

class Walk {
 public:
  Walk(const Outline& outline, const std::function<std::uint64_t(GridPosition)>& nearest)
      : outline_(outline), nearest_(nearest) {}

  NumberLoop visits() {
    const double steps = std::ceil(outline_.length / kFirstStep);
    const std::uint64_t first = nearest_(outline_.at(0));
    std::uint64_t last = first;
    for (double step = 1; step <= steps; ++step) {
      const std::uint64_t next = step < steps ? nearest_(outline_.at(step / steps)) : first;
      between((step - 1) / steps, last, step / steps, next);
      last = next;
    }
    return visits_;
  }

 private:
  // Appends the points after the one at `from`, up to and with the one at `to`.
  void between(double from, std::uint64_t there, double to, std::uint64_t next) {
    if (there == next) return;
    if ((to - from) * outline_.length < kLastStep) {
      visits_.push_back(next);
      return;
    }
    const double middle = 0.5 * (from + to);
    const std::uint64_t on_the_way = nearest_(outline_.at(middle));
    between(from, there, middle, on_the_way);
    between(middle, on_the_way, to, next);
  }

  const Outline& outline_;
  const std::function<std::uint64_t(GridPosition)>& nearest_;
  NumberLoop visits_;
};

// Cuts the shorter part out of a loop that visits a point twice; false if it visits none twice.
bool cut_return(NumberLoop& loop) {
  std::unordered_map<std::uint64_t, std::size_t> visited;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto [first, is_new] = visited.emplace(loop[i], i);
    if (is_new) continue;
    const auto begin = loop.begin() + static_cast<std::ptrdiff_t>(first->second);
    const auto end = loop.begin() + static_cast<std::ptrdiff_t>(i);
    if (2 * (i - first->second) <= loop.size())
      loop.erase(begin, end);
    else
      loop = NumberLoop(begin, end);
    return true;
  }
  return false;
}

}  // namespace

NumberLoop without_returns(NumberLoop loop) {
  while (cut_return(loop)) {
  }
  return loop;
}

NumberLoop ring_along(const Outline& outline, const std::function<std::uint64_t(GridPosition)>& nearest) {
  return without_returns(Walk(outline, nearest).visits());
}

}  // namespace lacuna::synth
