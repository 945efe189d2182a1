// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/plan_system.hpp"

#include "engine/run/error.hpp"
#include "io/read/crs/crs.hpp"
#include "io/read/rows/columns.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {
namespace {

// Whether all values of an axis are multiples of the step, as far as single precision shows it.
bool are_in_steps(std::span<const Eigen::Vector3d> positions, int axis, double step) {
  return std::ranges::all_of(positions, [&](const Eigen::Vector3d& position) {
    const double steps = position[axis] / step;
    return std::abs(steps - std::round(steps)) <= 6e-8 * std::abs(steps) + 1e-6;
  });
}

}  // namespace

bool look_like_degrees(std::span<const Eigen::Vector3d> positions) {
  constexpr std::size_t kFewest = 10;
  constexpr double kWidest = 3, kFarther = 10, kHigher = 100, kFourDecimals = 1e-4, kTwoDecimals = 1e-2;
  if (positions.size() < kFewest) return false;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : positions) box.extend(position);
  const Eigen::Array3d sizes = box.sizes(), most = box.min().array().abs().max(box.max().array().abs());
  const double widest = sizes.head<2>().maxCoeff();
  const bool are_in_range = most.head<2>().minCoeff() <= 90 && most.head<2>().maxCoeff() <= 360;
  const bool is_one_far = (most.head<2>() > (kFarther + 1) * sizes.head<2>()).any();
  if (!are_in_range || widest > kWidest || !is_one_far || sizes.z() < widest) return false;
  if (are_in_steps(positions, 0, kFourDecimals) || are_in_steps(positions, 1, kFourDecimals)) return false;
  return sizes.z() > kHigher * widest || are_in_steps(positions, 2, kTwoDecimals);
}

bool look_like_degrees(ScanReader& reader) {
  constexpr std::size_t kRows = 4096;
  RowBatch rows;
  std::vector<Eigen::Vector3d> positions;
  if (!reader.next(rows, kRows)) return false;
  load_vectors(rows, reader.layout(), kPositionNames, positions);
  std::erase_if(positions, [](const Eigen::Vector3d& position) { return !position.allFinite(); });
  return look_like_degrees(positions);
}

namespace {

constexpr const char* kGeocentricCode = "EPSG:4978";

// Projected systems have such places, too, but no such heights.
bool is_on_earth(const Eigen::Vector3d& place) {
  constexpr double kLeast = 6'330'000, kMost = 6'400'000, kLeastHeight = 20'000;
  return place.norm() > kLeast && place.norm() < kMost && std::abs(place.z()) > kLeastHeight;
}

}  // namespace

std::optional<Eigen::Vector3d> find_place(const ScanFiles& scan, std::size_t file) {
  constexpr std::size_t kRows = 1000;
  const auto reader = scan.open(file);
  RowBatch rows;
  std::vector<Eigen::Vector3d> positions;
  if (reader->next(rows, kRows)) load_vectors(rows, reader->layout(), kPositionNames, positions);
  const auto found = std::ranges::find_if(positions, [](const Eigen::Vector3d& position) {
    return position.allFinite() && position != Eigen::Vector3d::Zero();
  });
  return found == positions.end() ? std::nullopt : std::optional(*found);
}

std::string utm_zone(double longitude, double latitude) {
  const int zone = std::clamp(static_cast<int>(std::floor((longitude + 180) / 6)) + 1, 1, 60);
  return "EPSG:" + std::to_string((latitude < 0 ? 32700 : 32600) + zone);
}

void require_plan(const ScanFiles& scan, const std::string& option) {
  const std::string& stated = scan.stated_crs().crs;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    const std::string& crs = stated.empty() ? scan.files()[i].crs : stated;
    if (i > 0 && (!stated.empty() || crs == scan.files()[i - 1].crs)) continue;
    const bool is_guess = crs.empty();
    const bool may_be_metres = scan.files()[i].unit.empty() || scan.files()[i].unit == "m";
    if (is_guess && (!may_be_metres || !scan.stated_crs().unit.empty())) continue;
    if (!is_guess && !facts_of(crs).is_geocentric) continue;
    const auto place = find_place(scan, i);
    if (is_guess && !(place && is_on_earth(*place))) continue;
    std::optional<std::vector<Eigen::Vector3d>> degrees;
    if (place) degrees = to_degrees(is_guess ? kGeocentricCode : crs, {*place}, scan.files()[i].name);
    const std::string zone = degrees ? utm_zone(degrees->front().x(), degrees->front().y()) : "EPSG:N";
    throw Error(scan.files()[i].name.string() + ": " +
                (is_guess ? "its places are geocentric, as of EPSG:4978"
                          : name_of_crs(facts_of(crs).known_text) + " is geocentric") +
                ", and " + option + " needs a plan; `pdal translate IN OUT reprojection " +
                (is_guess ? "--filters.reprojection.in_srs=EPSG:4978 " : "") +
                "--filters.reprojection.out_srs=" + zone + "` projects it" +
                (is_guess ? "; if they are not, --unit m or --crs says so" : ""));
  }
}

}  // namespace lacuna::io
