// SPDX-License-Identifier: Apache-2.0
// The output of `lacuna-bench score`: tables, and JSON.
#include "bench/evaluation/cloud_score.hpp"
#include "bench/evaluation/json.hpp"
#include "tools/console/measures_text.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <spdlog/fmt/fmt.h>

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

std::string print_tally(const Tally& tally) {
  return print_count(tally.found) + " of " + print_count(tally.all);
}

std::string print_number(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : "-";
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

// The scores of some clouds together.
struct Scores {
  std::size_t clouds = 0;
  Tally holes, outer_curves;
  std::size_t false_loops = 0, repeated = 0, joined_or_parted = 0;
  HoleAreas areas;
  std::size_t flagged_points = 0, true_points = 0;
  PointScores points, medians;

  std::optional<double> completeness() const { return share(areas.covered, areas.truth); }
  std::optional<double> correctness() const { return share(areas.right, areas.found); }
};

Scores scores_of(Clouds clouds) {
  const auto tally = [&](Tally CloudScore::*of) {
    return Tally{.found = sum(clouds, [&](const CloudScore& c) { return (c.*of).found; }),
                 .all = sum(clouds, [&](const CloudScore& c) { return (c.*of).all; })};
  };
  const auto area = [&](double HoleAreas::*part) {
    return sum(clouds, [&](const CloudScore& c) { return c.areas.*part; });
  };
  const auto points = [&](std::size_t PointAccuracy::*count) {
    return sum(clouds, [&](const CloudScore& c) { return c.points.*count; });
  };
  const auto loops = [&](std::size_t CloudScore::*count) {
    return sum(clouds, [&](const CloudScore& c) { return c.*count; });
  };
  return {.clouds = clouds.size(),
          .holes = tally(&CloudScore::holes),
          .outer_curves = tally(&CloudScore::outer_curves),
          .false_loops = loops(&CloudScore::false_loops),
          .repeated = loops(&CloudScore::repeated),
          .joined_or_parted = loops(&CloudScore::joined_or_parted),
          .areas = {.truth = area(&HoleAreas::truth),
                    .covered = area(&HoleAreas::covered),
                    .found = area(&HoleAreas::found),
                    .right = area(&HoleAreas::right)},
          .flagged_points = points(&PointAccuracy::flagged),
          .true_points = points(&PointAccuracy::truth),
          .points = point_scores(pooled(clouds, &PointAccuracy::flagged, &PointScores::precision),
                                 pooled(clouds, &PointAccuracy::truth, &PointScores::recall)),
          .medians = {.precision = median(clouds, &PointScores::precision),
                      .recall = median(clouds, &PointScores::recall),
                      .f1 = median(clouds, &PointScores::f1)}};
}

using NamedScores = std::vector<std::pair<std::string, Scores>>;

// Those of each kind; those of all clouds come last.
NamedScores named_scores(const ScoresByKind& kinds) {
  NamedScores named;
  std::vector<CloudScore> all;
  for (const auto& [name, clouds] : kinds) {
    named.emplace_back(name, scores_of(clouds));
    all.insert(all.end(), clouds.begin(), clouds.end());
  }
  named.emplace_back("all", scores_of(all));
  return named;
}

Json tally_json(const Tally& tally) {
  return {{"true", tally.all}, {"found", tally.found}};
}

Json json_of(const Scores& scores) {
  return {{"clouds", scores.clouds},
          {"holes", tally_json(scores.holes)},
          {"outer_curves", tally_json(scores.outer_curves)},
          {"false", scores.false_loops},
          {"repeated", scores.repeated},
          {"joined_or_parted", scores.joined_or_parted},
          {"areas",
           {{"true", scores.areas.truth},
            {"covered", scores.areas.covered},
            {"found", scores.areas.found},
            {"right", scores.areas.right},
            {"completeness", or_null(scores.completeness())},
            {"correctness", or_null(scores.correctness())}}},
          {"points",
           {{"true", scores.true_points},
            {"flagged", scores.flagged_points},
            {"all", json_of(scores.points)},
            {"median", json_of(scores.medians)}}}};
}

}  // namespace

std::string print_scores(const ScoresByKind& kinds) {
  std::vector<Row> holes = {
      {"per hole", "clouds", "holes found", "outer curves found", "false loops", "joined or parted"}};
  std::vector<Row> areas = {{"per area", "completeness", "correctness"}};
  std::vector<Row> points = {
      {"per point", "precision", "recall", "F1", "median precision", "median recall", "median F1"}};
  for (const auto& [kind, s] : named_scores(kinds)) {
    const std::string name = visible(kind);
    holes.push_back({name, print_count(s.clouds), print_tally(s.holes), print_tally(s.outer_curves),
                     print_count(s.false_loops), print_count(s.joined_or_parted)});
    areas.push_back({name, print_number(s.completeness()), print_number(s.correctness())});
    points.push_back({name, print_number(s.points.precision), print_number(s.points.recall),
                      print_number(s.points.f1), print_number(s.medians.precision),
                      print_number(s.medians.recall), print_number(s.medians.f1)});
  }
  return print_table(holes) + "\n" + print_table(areas) + "\n" + print_table(points);
}

std::string print_json(const ScoresByKind& kinds, const ScoredFolders& folders) {
  Json root = {{"clouds", folders.clouds.string()},   {"results", folders.results.string()},
               {"tolerance", folders.rule.tolerance}, {"min_vertices", folders.rule.min_vertices},
               {"without_result", Json::array()},     {"groups", Json::object()}};
  for (const auto& cloud : folders.without_result) root["without_result"].push_back(cloud.stem().string());
  NamedScores named = named_scores(kinds);
  root["all"] = json_of(named.back().second);
  named.pop_back();
  for (const auto& [name, scores] : named) root["groups"][name] = json_of(scores);
  return io::print(root, 2) + "\n";
}

}  // namespace lacuna::evaluation
