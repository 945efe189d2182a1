// SPDX-License-Identifier: Apache-2.0
#include "tests/support/point_tree.hpp"

#include "engine/model/nanoflann_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacuna {
namespace {

// nanoflann bounds the distance of a branch by sums that are rounded. So a branch at exactly the distance of
// the worst neighbour is searched, too.
const nanoflann::SearchParams kExact(0, -1e-6f, false);

// nanoflann offers only points strictly nearer than `worstDist`; ties are decided by id here.
double just_above(double distance) {
  return std::nextafter(distance, std::numeric_limits<double>::infinity());
}

// The k first neighbours, kept sorted.
class KNearest {
 public:
  using DistanceType = double;

  KNearest(LocalIndex query, std::span<const PointId> ids, std::size_t k, std::vector<Neighbour>& found)
      : query_(query), ids_(ids), k_(k), found_(found) {
    found_.clear();
  }

  bool addPoint(double distance, LocalIndex index) {
    if (index == query_) return true;
    const Neighbour candidate{distance, ids_[index], index};
    if (found_.size() == k_) {
      if (!(candidate < found_.back())) return true;
      found_.pop_back();
    }
    auto place = found_.end();
    while (place != found_.begin() && candidate < *(place - 1)) --place;
    found_.insert(place, candidate);
    return true;
  }
  double worstDist() const {
    return found_.size() < k_ ? std::numeric_limits<double>::infinity()
                              : just_above(found_.back().squared_distance);
  }
  bool full() const { return found_.size() == k_; }
  std::size_t size() const { return found_.size(); }

 private:
  LocalIndex query_;
  std::span<const PointId> ids_;
  std::size_t k_;
  std::vector<Neighbour>& found_;
};

class Ball {
 public:
  using DistanceType = double;

  Ball(LocalIndex query, std::span<const PointId> ids, double squared_radius, std::vector<Neighbour>& found)
      : query_(query), ids_(ids), squared_radius_(squared_radius), found_(found) {
    found_.clear();
  }

  bool addPoint(double distance, LocalIndex index) {
    if (index != query_ && distance <= squared_radius_) found_.push_back({distance, ids_[index], index});
    return true;
  }
  double worstDist() const { return just_above(squared_radius_); }
  bool full() const { return true; }
  std::size_t size() const { return found_.size(); }

 private:
  LocalIndex query_;
  std::span<const PointId> ids_;
  double squared_radius_;
  std::vector<Neighbour>& found_;
};

}  // namespace

struct PointTree::Index : NanoflannTree<LocalIndex> {
  using NanoflannTree::NanoflannTree;
};

PointTree::PointTree(std::span<const Eigen::Vector3d> positions, std::span<const PointId> ids)
    : positions_(positions), ids_(ids), index_(std::make_unique<Index>(positions)) {}

PointTree::~PointTree() = default;

void PointTree::nearest(LocalIndex query, std::size_t k, std::vector<Neighbour>& found) const {
  KNearest result(query, ids_, k, found);
  index_->index.findNeighbors(result, positions_[query].data(), kExact);
}

void PointTree::within(LocalIndex query, double squared_radius, std::vector<Neighbour>& found) const {
  Ball result(query, ids_, squared_radius, found);
  index_->index.findNeighbors(result, positions_[query].data(), kExact);
  std::sort(found.begin(), found.end());
}

std::vector<Neighbour> nearest_plainly(std::span<const Eigen::Vector3d> positions,
                                       std::span<const PointId> ids, LocalIndex query, std::size_t k) {
  std::vector<Neighbour> all;
  for (LocalIndex i = 0; i < positions.size(); ++i)
    if (i != query) all.push_back({squared_distance(positions[i], positions[query]), ids[i], i});
  const std::size_t kept = std::min(k, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(kept), all.end());
  all.resize(kept);
  return all;
}

}  // namespace lacuna
