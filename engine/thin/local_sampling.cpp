#include "engine/thin/local_sampling.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>

#include <Eigen/Eigenvalues>

namespace lacuna {
namespace {

constexpr std::size_t kNearest = 6;   // neighbours that make the spacing
constexpr double kLine = 2.2;         // line distance over spacing from which a point lies in a line
constexpr double kInLines = 0.3;      // share of the points in lines from which a resolution is needed
constexpr double kCovered = 0.6;      // share of these that have the next line within the resolution
constexpr double kDense = 0.4;        // spacing over the scan's from which a point is dense
constexpr double kDenseShare = 0.05;  // share of dense points from which they count

// Axes of the neighbours, by their spread: normal, then the two of the tangent plane.
Eigen::Matrix3d frame(std::span<const Eigen::Vector3d> offsets) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& o : offsets) mean += o;
  mean /= static_cast<double>(offsets.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& o : offsets) spread += (o - mean) * (o - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
}

// Which of six equal sectors a direction is in: by the sides of three lines that it lies on.
std::size_t sector_of(double x, double y) {
  constexpr double kCos = 0.5, kSin = 0.8660254037844386;  // of 60 degrees
  const bool a = y >= 0, b = kCos * y >= kSin * x, c = -kCos * y >= kSin * x;
  // Around the circle the three sides change one at a time.
  if (a) return b ? (c ? 2 : 1) : 0;
  return b ? 3 : (c ? 4 : 5);
}

double line_distance_of(std::span<const Eigen::Vector3d> points) {
  std::array<double, 6> nearest;
  nearest.fill(points.back().norm());
  for (const Eigen::Vector3d& p : points) {
    double& distance = nearest[sector_of(p.z(), p.y())];
    distance = std::min(distance, p.norm());
  }
  std::sort(nearest.begin(), nearest.end());
  return nearest[4];
}

// Value below which this share of all lies.
double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double rounded_to_one_digit(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.begin(), text.end(), value, std::chars_format::scientific, 0).ptr;
  std::from_chars(text.begin(), end, value);
  return value;
}

bool is_share(std::size_t part, double share, std::size_t all) {
  return static_cast<double>(part) >= share * static_cast<double>(all);
}

// Between the lines that these points lie in; 0 where they do not.
double distance_of_lines(std::span<const LocalSampling> points) {
  std::vector<double> distances;
  for (const LocalSampling& s : points) {
    if (s.line_distance > kLine * s.spacing) distances.push_back(s.line_distance);
  }
  if (!is_share(distances.size(), kInLines, points.size())) return 0;
  return rounded_to_one_digit(quantile(distances, kCovered));
}

}  // namespace

std::optional<LocalSampling> measure_sampling(std::span<const Eigen::Vector3d> offsets) {
  if (offsets.size() < kSamplingNeighbours) return std::nullopt;
  const Eigen::Matrix3d axes = frame(offsets);
  std::vector<Eigen::Vector3d> points;  // along the normal and in the tangent plane
  double spacing = 0;
  for (const Eigen::Vector3d& o : offsets) points.push_back(axes.transpose() * o);
  for (std::size_t i = 0; i < kNearest; ++i) spacing += points[i].norm() / kNearest;
  return LocalSampling{spacing, line_distance_of(points)};
}

double resolution_of(const std::vector<LocalSampling>& sample) {
  if (sample.empty()) return 0;
  if (const double resolution = distance_of_lines(sample); resolution > 0) return resolution;
  std::vector<double> spacings;
  for (const LocalSampling& s : sample) spacings.push_back(s.spacing);
  const double spacing = quantile(spacings, 0.5);
  std::vector<LocalSampling> dense;
  std::copy_if(sample.begin(), sample.end(), std::back_inserter(dense),
               [&](const LocalSampling& s) { return s.spacing < kDense * spacing; });
  return is_share(dense.size(), kDenseShare, sample.size()) ? distance_of_lines(dense) : 0;
}

}  // namespace lacuna
