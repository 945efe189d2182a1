// SPDX-License-Identifier: Apache-2.0
// The output of `lacuna-bench score`.
#include "bench/evaluation/cloud_score.hpp"
#include "tools/console/measures_text.hpp"
#include "tools/console/visible_text.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <span>

namespace lacuna::evaluation {
using namespace tools;

namespace {

using Clouds = std::span<const CloudScore>;
using Row = std::vector<std::string>;

template <class Value>
auto sum(Clouds clouds, const Value& value_of) {
  decltype(value_of(clouds[0])) total{};
  for (const CloudScore& cloud : clouds) total += value_of(cloud);
  return total;
}

std::string print_tally(Clouds clouds, Tally CloudScore::*tally) {
  return print_count(sum(clouds, [&](const CloudScore& c) { return (c.*tally).found; })) + " of " +
         print_count(sum(clouds, [&](const CloudScore& c) { return (c.*tally).all; }));
}

std::string print_number(const std::optional<double>& value) {
  if (!value) return "-";
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3f", *value);
  return buffer;
}

std::optional<double> share(double part, double whole) {
  return whole > 0 ? std::optional(part / whole) : std::nullopt;
}

// Returns the share of all points of the clouds, from the shares of each one's `count` points.
std::optional<double> pooled(Clouds clouds, std::size_t PointAccuracy::*count,
                             std::optional<double> PointScores::*value) {
  const auto points = [&](const CloudScore& c) { return static_cast<double>(c.points.*count); };
  const auto part = [&](const CloudScore& c) {
    return points(c) * (c.points.within_tolerance.*value).value_or(0);
  };
  return share(sum(clouds, part), sum(clouds, points));
}

std::optional<double> median(Clouds clouds, std::optional<double> PointScores::*value) {
  std::vector<double> values;
  for (const CloudScore& cloud : clouds) {
    if (const auto one = cloud.points.within_tolerance.*value) values.push_back(*one);
  }
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

Row hole_row(const std::string& name, Clouds clouds) {
  return {name,
          print_count(clouds.size()),
          print_tally(clouds, &CloudScore::holes),
          print_tally(clouds, &CloudScore::outer_curves),
          print_count(sum(clouds, [](const CloudScore& c) { return c.false_loops; })),
          print_count(sum(clouds, [](const CloudScore& c) { return c.joined_or_parted; }))};
}

Row area_row(const std::string& name, Clouds clouds) {
  const auto area = [&](double HoleAreas::*part) {
    return sum(clouds, [&](const CloudScore& c) { return c.areas.*part; });
  };
  return {name, print_number(share(area(&HoleAreas::covered), area(&HoleAreas::truth))),
          print_number(share(area(&HoleAreas::right), area(&HoleAreas::found)))};
}

Row point_row(const std::string& name, Clouds clouds) {
  const PointScores all = point_scores(pooled(clouds, &PointAccuracy::flagged, &PointScores::precision),
                                       pooled(clouds, &PointAccuracy::truth, &PointScores::recall));
  return {name,
          print_number(all.precision),
          print_number(all.recall),
          print_number(all.f1),
          print_number(median(clouds, &PointScores::precision)),
          print_number(median(clouds, &PointScores::recall)),
          print_number(median(clouds, &PointScores::f1))};
}

}  // namespace

std::string print_scores(const std::map<std::string, std::vector<CloudScore>>& kinds) {
  std::vector<Row> holes = {
      {"per hole", "clouds", "holes found", "outer curves found", "false loops", "joined or parted"}};
  std::vector<Row> areas = {{"per area", "completeness", "correctness"}};
  std::vector<Row> points = {
      {"per point", "precision", "recall", "F1", "median precision", "median recall", "median F1"}};
  const auto add = [&](const std::string& name, Clouds clouds) {
    holes.push_back(hole_row(name, clouds));
    areas.push_back(area_row(name, clouds));
    points.push_back(point_row(name, clouds));
  };
  std::vector<CloudScore> all;
  for (const auto& [name, clouds] : kinds) {
    add(visible(name), clouds);
    all.insert(all.end(), clouds.begin(), clouds.end());
  }
  add("all", all);
  return print_table(holes) + "\n" + print_table(areas) + "\n" + print_table(points);
}

}  // namespace lacuna::evaluation
