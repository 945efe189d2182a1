#include "tools/accuracy/spacing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <nanoflann.hpp>

namespace lacuna::accuracy {
namespace {

constexpr std::size_t kNearest = 4;
constexpr std::size_t kMostAsked = 1 << 17;  // more hardly move a median, and each takes microseconds

struct Adaptor {
  std::span<const Eigen::Vector3d> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t point, std::size_t axis) const { return points[point][axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Metric = nanoflann::L2_Simple_Adaptor<double, Adaptor, double, std::size_t>;
using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Adaptor, 3, std::size_t>;

}  // namespace

double median_spacing(std::span<const Eigen::Vector3d> points) {
  if (points.size() < 2) return 0;
  const Adaptor adaptor{points};
  const Tree tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(12));
  const std::size_t wanted = std::min(kNearest, points.size() - 1);
  std::vector<std::size_t> nearest(wanted + 1);  // the point itself is the first
  std::vector<double> squares(wanted + 1);
  std::vector<double> means;
  const std::size_t step = (points.size() - 1) / kMostAsked + 1;
  for (std::size_t i = 0; i < points.size(); i += step) {
    tree.knnSearch(points[i].data(), wanted + 1, nearest.data(), squares.data());
    double sum = 0;
    for (const double square : squares) sum += std::sqrt(square);
    means.push_back(sum / static_cast<double>(wanted));
  }
  const auto middle = means.begin() + static_cast<std::ptrdiff_t>(means.size() / 2);
  std::nth_element(means.begin(), middle, means.end());
  return *middle;
}

}  // namespace lacuna::accuracy
