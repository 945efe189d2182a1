// ball_sizes: how large a ball may be to make a triangle, from how points lie around the star's point.
//
// The balls of a star show how large the empty circles of the sampling are and how much they scatter: on a
// grid all have 0.71 spacings, among points at random there are small and large ones. A median over a point's
// neighbours tells it from the rim of a hole as well, where some balls are large because there is nothing;
// such as lie in a hole for sure are left out, since on strips and islands half of the balls do.
#pragma once

#include "engine/config.hpp"
#include "engine/boundary/tangential/star.hpp"
#include "engine/simd/batch.hpp"
#include "engine/boundary/tangential/stars.hpp"

#include <array>
#include <span>
#include <vector>

namespace lacuna {

// Of stars as they are found, side by side: as many as there are, up to kBatchSize. None where one has no
// corner.
std::array<Sampling, kBatchSize> samplings_of(std::span<const FoundStar> stars,
                                              const TangentialConfig& config);

// The room of a ball in units of `own.distance`.
inline float room_beyond(const RadiusBound& size, const Sampling& own, float ball) {
  return static_cast<float>((ball * own.distance - size.radius) / size.unit);
}

// A point that has a star, and its neighbours, by their places among the samplings.
struct Surroundings {
  LocalIndex point;
  std::span<const LocalIndex> neighbours;
};

// With M the median of the circles of a point and its neighbours, S that of their scatters, each at most half
// of the point's mean distance (`most_radius`), the radius is 1.5 M + S (`max_radius`) and the unit S + 0.1 M
// (`least_spread`). Those without a star, or with large balls only, say nothing; if no one says anything, M
// and S are that half.
// A batch of points at once: keeps its memory.
class RadiusBounder {
 public:
  RadiusBounder(std::span<const Sampling> samplings, const TangentialConfig& config)
      : samplings_(samplings), config_(config) {}

  // visit(i, size) for each of `count` points; surroundings(i): of the i-th. What a size is depends on no
  // other point.
  template <class Around, class Visit>
  void for_each(std::size_t count, Around&& surroundings, Visit&& visit) {
    for_each_batch(count, points_, surroundings, [&](std::size_t first) {
      find();
      for (std::size_t i = 0; i < points_.size(); ++i) visit(first + i, sizes_[i]);
    });
  }

 private:
  void find();  // the sizes for `points_`

  std::span<const Sampling> samplings_;
  TangentialConfig config_;
  std::vector<Surroundings> points_;
  std::vector<Batch<double>> circles_, scatters_;
  std::array<RadiusBound, kBatchSize> sizes_;
};

}  // namespace lacuna
