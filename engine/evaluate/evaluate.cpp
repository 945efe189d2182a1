// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/evaluate.hpp"

#include "engine/criteria/criteria.hpp"
#include "engine/criteria/criteria_values.hpp"
#include "engine/simd/maths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace lacuna {
namespace {

constexpr double kNoCone = 2.0;  // no direction is that steep
constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

CriteriaParameters criteria_parameters(const NormalsConfig& normals, const CriteriaConfig& criteria) {
  CriteriaParameters parameters{
      .sigma = criteria.sigma,
      .cos_cone = criteria.cone == 0 ? kNoCone : cosine(criteria.cone * std::numbers::pi / 180),
      .crease_threshold = normals.crease_threshold,
      .shares = {},
      .uses_normals_off = normals.use == NormalsUse::kGiven};
  const std::vector<double>& weights = criteria.weights;
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (std::size_t i = 0; i < weights.size(); ++i) parameters.shares[i] = weights[i] / sum;
  return parameters;
}

// Batches of points with nearly as many neighbours each: a batch takes as long as its largest neighbourhood.
class Batches {
 public:
  Batches(const TilePoints& points, const Neighbourhoods& neighbourhoods,
          std::span<const Eigen::Vector3d> given_normals)
      : points_(points), neighbourhoods_(neighbourhoods), given_normals_(given_normals) {}

  // Goes through the points [first, last) that have neighbours. It calls visit(batch, points) with the points
  // of the batch; a last batch that is not full repeats a point.
  template <class Visit>
  void for_each(LocalIndex first, LocalIndex last, Visit&& visit) {
    order_by_count(first, last);
    for (std::size_t i = 0; i < order_.size(); i += kBatchSize) {
      for (std::size_t lane = 0; lane < kBatchSize; ++lane)
        lanes_[lane] = order_[std::min(i + lane, order_.size() - 1)];
      visit(gather(), std::span<const LocalIndex>(lanes_).first(std::min(kBatchSize, order_.size() - i)));
    }
  }

 private:
  std::size_t count(LocalIndex p) const { return neighbourhoods_[p].size(); }

  // Sorts by counting.
  void order_by_count(LocalIndex first, LocalIndex last) {
    std::size_t most = 0;
    for (LocalIndex p = first; p < last; ++p) most = std::max(most, count(p));
    ends_.assign(most + 2, 0);
    for (LocalIndex p = first; p < last; ++p) ++ends_[count(p) + 1];
    const std::uint32_t alone = std::exchange(ends_[1], 0);
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    order_.resize(last - first - alone);
    for (LocalIndex p = first; p < last; ++p) {
      if (count(p) > 0) order_[ends_[count(p)]++] = p;
    }
  }

  const NeighbourBatch& gather() {
    const std::size_t ranks = count(lanes_.back());
    if (ranks > capacity_) grow(ranks);
    batch_.ranks = ranks;
    NeighbourLists lists{.positions = points_.positions.front().data()};
    for (std::size_t lane = 0; lane < kBatchSize; ++lane) {
      const LocalIndex p = lanes_[lane];
      lists.points[lane] = p;
      lists.neighbours[lane] = neighbourhoods_[p].data();
      lists.counts[lane] = static_cast<std::uint32_t>(count(p));
      const Eigen::Vector3d normal = given_normal(p);
      for (int axis = 0; axis < 3; ++axis) batch_.given_normals[axis].at[lane] = normal[axis];
    }
    gather_neighbours(lists, batch_);
    return batch_;
  }

  void grow(std::size_t ranks) {
    capacity_ = std::max(ranks, 2 * capacity_);
    Batch<double>** const columns[] = {&batch_.x, &batch_.y, &batch_.z, &batch_.squared_distance,
                                       &batch_.weight};
    memory_.resize(capacity_ * std::size(columns));
    Batch<double>* column = memory_.data();
    for (Batch<double>** place : columns) {
      *place = column;
      column += capacity_;
    }
  }

  Eigen::Vector3d given_normal(LocalIndex p) const {
    if (given_normals_.empty()) return Eigen::Vector3d::Constant(kUndefined);
    const Eigen::Vector3d& normal = given_normals_[p];
    const bool usable = normal.allFinite() && normal.cwiseAbs().maxCoeff() > 0;
    return usable ? Eigen::Vector3d(normal.stableNormalized()) : Eigen::Vector3d::Constant(kUndefined);
  }

  const TilePoints& points_;
  const Neighbourhoods& neighbourhoods_;
  std::span<const Eigen::Vector3d> given_normals_;
  std::vector<std::uint32_t> ends_;  // by count
  std::vector<LocalIndex> order_;
  std::array<LocalIndex, kBatchSize> lanes_{};
  NeighbourBatch batch_;
  std::size_t capacity_ = 0;
  std::vector<Batch<double>> memory_;
};

Evaluation evaluation(const CriteriaValues& values, std::size_t lane,
                      std::span<const LocalIndex> neighbours) {
  Evaluation e;
  for (int axis = 0; axis < 3; ++axis) {
    e.normal[axis] = values.normal[axis].at[lane];
    e.mean_offset[axis] = values.mean_offset[axis].at[lane];
  }
  e.probability = values.probability.at[lane];
  e.mean_distance = values.mean_distance.at[lane];
  e.surface_share = static_cast<float>(values.surface_share.at[lane]);
  e.is_normal_off = values.is_normal_off.at[lane] != 0;
  if (values.gap_near.at[lane] >= 0) {
    e.gap_near = neighbours[static_cast<std::size_t>(values.gap_near.at[lane])];
    e.gap_far = neighbours[static_cast<std::size_t>(values.gap_far.at[lane])];
  }
  return e;
}

}  // namespace

double round_to_step(double value) {
  return std::nearbyint(value / kProbabilityStep) * kProbabilityStep;
}

std::vector<Evaluation> evaluate(const TilePoints& points, const Neighbourhoods& neighbourhoods,
                                 std::span<const Eigen::Vector3d> given_normals, const NormalsConfig& normals,
                                 const CriteriaConfig& criteria, std::span<double> values) {
  const CriteriaParameters parameters = criteria_parameters(normals, criteria);
  Batches batches(points, neighbourhoods, given_normals);
  std::vector<Evaluation> evaluations;
  evaluations.reserve(points.owned);
  std::fill(values.begin(), values.end(), 1.0);  // of a point without neighbours
  const std::size_t count = criteria.weights.size();
  CriteriaValues found;
  const auto keep = [&](std::size_t lane, LocalIndex p) {
    evaluations[p] = evaluation(found, lane, neighbourhoods[p]);
    if (values.empty()) return;
    for (std::size_t i = 0; i < count; ++i) values[p * count + i] = found.criteria[i].at[lane];
  };
  // The loop goes by runs of the store order: points that are near in space share the cache.
  constexpr LocalIndex kRun = 64;
  for (LocalIndex first = 0, last; first < points.owned; first = last) {
    last = std::min(first + kRun, points.owned);
    evaluations.resize(last);
    batches.for_each(first, last, [&](const NeighbourBatch& batch, std::span<const LocalIndex> of) {
      evaluate_criteria(batch, parameters, found);
      for (std::size_t lane = 0; lane < of.size(); ++lane) keep(lane, of[lane]);
    });
  }
  return evaluations;
}

}  // namespace lacuna
