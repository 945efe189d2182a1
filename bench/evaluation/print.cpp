// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/print.hpp"

#include "engine/model/loop.hpp"
#include "io/write/loops/json.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>
#include <spdlog/fmt/fmt.h>

namespace lacuna::evaluation {

using namespace tools;
using io::Json;

// ---- One result, for people

namespace {

constexpr std::size_t kMostRows = 40;
constexpr const char* kUnit = "";  // files of true loops have none

Tally tally(const EvaluationText& text, std::optional<LoopKind> kind) {
  Tally tally;
  for (std::size_t i = 0; i < text.truth.loops.size(); ++i) {
    const TrueMatch& match = text.evaluation.loops.true_loops[i];
    if (!match.counts || (kind && text.truth.loops[i].kind != kind)) continue;
    ++tally.all;
    tally.found += match.found_by.has_value();
  }
  return tally;
}

bool knows_kinds(const EvaluationText& text) {
  const std::vector<TrueLoop>& loops = text.truth.loops;
  return !loops.empty() &&
         std::all_of(loops.begin(), loops.end(), [](const TrueLoop& loop) { return loop.kind.has_value(); });
}

std::string print_tally(Tally tally, const char* one, const char* several) {
  return print_count(tally.found) + " of " + print_count(tally.all) + " " + (tally.all == 1 ? one : several);
}

std::string print_sentence(const EvaluationText& text) {
  const LoopScores& scores = text.evaluation.scores;
  std::string line = "found ";
  if (!knows_kinds(text)) {
    line += print_tally(tally(text, {}), "true loop", "true loops");
  } else {
    const Tally outer = tally(text, LoopKind::kOuter);
    line += print_tally(tally(text, LoopKind::kHole), "hole", "holes");
    if (outer.all > 0) line += " and " + print_tally(outer, "outer curve", "outer curves");
  }
  line += ", " + print_count(scores.false_loops) + " false\n";
  const auto add = [&line](std::size_t count, const char* one, const char* several) {
    if (count > 0) line += "  " + counted(count, one, several) + "\n";
  };
  add(scores.joined, "loop joins true loops, or one with other places",
      "loops join true loops, or one with other places");
  add(scores.parted, "loop follows a part of a true loop", "loops follow parts of true loops");
  add(scores.repeated, "loop repeats a found one", "loops repeat found ones");
  add(scores.steps, "loop follows a step of density, with points on both sides",
      "loops follow steps of density, with points on both sides");
  add(scores.short_loops, "true loop is too short (--min-vertices) or too narrow to count",
      "true loops are too short (--min-vertices) or too narrow to count");
  return line;
}

template <class Loops>
std::vector<LoopSize> sizes_of(const Loops& loops, const Truth& truth) {
  std::vector<LoopSize> sizes;
  for (const auto& loop : loops) sizes.push_back(size_of(loop, truth.positions));
  return sizes;
}

void sort_by_size(std::vector<std::size_t>& loops, const std::vector<LoopSize>& sizes) {
  std::stable_sort(loops.begin(), loops.end(),
                   [&](std::size_t a, std::size_t b) { return sizes[a].perimeter > sizes[b].perimeter; });
}

double extent_of(const Truth& truth) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : truth.positions) {
    if (position.allFinite()) box.extend(position);
  }
  return box.isEmpty() ? 0 : box.sizes().maxCoeff();
}

using Rows = std::vector<std::vector<std::string>>;

std::vector<std::string> row_of(const std::string& what, const LoopSize& size, std::size_t points,
                                double extent, const std::string& verdict) {
  return {what,
          print_length(size.perimeter, kUnit),
          print_length(size.diameter, kUnit),
          print_place(size.centre, extent),
          print_count(points),
          verdict};
}

std::string print_widths(const HolesByWidth& holes) {
  Rows rows = {{"width of holes, local spacings"}, {"found"}};
  std::size_t all = 0;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    const std::string from = print_count(kWidths[i]);
    const std::string to = i + 1 < holes.size() ? print_count(kWidths[i + 1]) : "";
    rows[0].push_back(to.empty() ? from + " and more" : i == 0 ? "below " + to : from + " to " + to);
    rows[1].push_back(print_count(holes[i].found) + " of " + print_count(holes[i].all));
    all += holes[i].all;
  }
  return all == 0 ? "" : "\n" + print_table(rows);
}

// Prints large loops first. For loops beyond the table, it prints their number and how many are missed.
std::string print_true_loops(const EvaluationText& text, std::vector<std::size_t> loops, const char* title,
                             double extent) {
  const Truth& truth = text.truth;
  if (loops.empty()) return "";
  std::vector<LoopSize> sizes(truth.loops.size());
  for (const std::size_t i : loops) sizes[i] = size_of(truth.loops[i], truth.positions);
  sort_by_size(loops, sizes);
  Rows rows = {{title, "perimeter", "diameter", "centre", "points", "found by"}};
  std::size_t missed_beyond = 0;
  for (std::size_t at = 0; at < loops.size(); ++at) {
    const std::size_t i = loops[at];
    const TrueMatch& match = text.evaluation.loops.true_loops[i];
    if (at >= kMostRows) {
      missed_beyond += match.counts && !match.found_by;
      continue;
    }
    const std::string& name = truth.loops[i].name;
    rows.push_back(row_of(name.empty() ? "true loop " + std::to_string(i) : visible(name), sizes[i],
                          truth.loops[i].vertices.size(), extent,
                          match.found_by ? "loop " + std::to_string(*match.found_by)
                          : match.counts ? "missed"
                                         : "too short or narrow"));
  }
  std::string table = "\n" + print_table(rows);
  if (loops.size() > kMostRows) {
    table += "  and " + print_count(loops.size() - kMostRows) + " more, " + print_count(missed_beyond) +
             " of them missed: --json has them all\n";
  }
  return table;
}

std::vector<std::size_t> loops_of(const Truth& truth, std::optional<LoopKind> kind) {
  std::vector<std::size_t> loops;
  for (std::size_t i = 0; i < truth.loops.size(); ++i) {
    if (!kind || truth.loops[i].kind == kind) loops.push_back(i);
  }
  return loops;
}

// Returns the words for a loop that matches no true loop; empty for others.
std::string_view describe(EdgeDecision verdict) {
  constexpr std::string_view kWords[] = {"", "", "", "joined with", "part of", "step of density", "false"};
  return kWords[static_cast<std::size_t>(verdict)];
}

// Prints loops that match no true loop, the large ones first.
std::string print_others(const EvaluationText& text, double extent) {
  const std::vector<LoopMatch>& matches = text.evaluation.loops.loops;
  std::vector<std::size_t> loops;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!describe(matches[i].verdict).empty()) loops.push_back(i);
  }
  if (loops.empty()) return "";
  const std::vector<LoopSize> sizes = sizes_of(text.result.loops, text.truth);
  sort_by_size(loops, sizes);
  Rows rows = {{"loops that match none", "perimeter", "diameter", "centre", "points", "what it is"}};
  for (std::size_t at = 0; at < std::min(loops.size(), kMostRows); ++at) {
    const std::size_t i = loops[at];
    const LoopMatch& match = matches[i];
    std::string verdict(describe(match.verdict));
    if (match.true_loop &&
        (match.verdict == EdgeDecision::kJoined || match.verdict == EdgeDecision::kParted)) {
      const std::string& name = text.truth.loops[*match.true_loop].name;
      verdict += " " + (name.empty() ? "true loop " + std::to_string(*match.true_loop) : visible(name));
    }
    rows.push_back(
        row_of("loop " + std::to_string(i), sizes[i], text.result.loops[i].size(), extent, verdict));
  }
  std::string table = "\n" + print_table(rows);
  if (loops.size() > kMostRows) table += "  and " + print_count(loops.size() - kMostRows) + " more\n";
  return table;
}

}  // namespace

std::string print_verdict(const EvaluationText& text) {
  const double extent = extent_of(text.truth);
  std::string all = print_sentence(text) + print_widths(text.evaluation.holes);
  if (knows_kinds(text)) {
    all += print_true_loops(text, loops_of(text.truth, LoopKind::kHole), "hole", extent);
    all += print_true_loops(text, loops_of(text.truth, LoopKind::kOuter), "outer curve", extent);
  } else {
    all += print_true_loops(text, loops_of(text.truth, {}), "true loop", extent);
  }
  return all + print_others(text, extent);
}

// ---- One result, as JSON

namespace {

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json json_of(const PointScores& scores) {
  return {{"precision", or_null(scores.precision)},
          {"recall", or_null(scores.recall)},
          {"f1", or_null(scores.f1)}};
}

// The words for the decision on a loop, as docs/evaluate.md defines them.
std::string_view name_of(EdgeDecision verdict) {
  constexpr std::string_view kNames[] = {"found", "repeated", "short", "joined", "parted", "step", "false"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::optional<std::string> name_of(const TrueLoop& loop) {
  return loop.name.empty() ? std::nullopt : std::optional(loop.name);
}

}  // namespace

std::string print_json(const EvaluationText& text) {
  const auto& [result, truth, evaluation] = std::tie(text.result, text.truth, text.evaluation);
  const LoopScores& scores = evaluation.scores;
  Json root = {{"result", text.result_path.string()},
               {"truth", text.truth_path.string()},
               {"points", truth.positions.size()},
               {"spacing", truth.spacing},
               {"tolerance", text.rule.tolerance},
               {"min_vertices", text.rule.min_vertices},
               {"true", scores.true_loops},
               {"short", scores.short_loops},
               {"found", scores.found},
               {"missed", scores.missed},
               {"loops", scores.loops},
               {"false", scores.false_loops},
               {"repeated", scores.repeated},
               {"joined", scores.joined},
               {"parted", scores.parted},
               {"step", scores.steps},
               {"recall", or_null(scores.recall)},
               {"precision", or_null(scores.precision)},
               {"confidence_auc", or_null(evaluation.confidence)},
               {"boundary", nullptr}};
  if (const auto& boundary = evaluation.boundary) {
    root["boundary"] = {{"flagged", boundary->flagged},
                        {"true", boundary->truth},
                        {"by_id", json_of(boundary->by_id)},
                        {"within_tolerance", json_of(boundary->within_tolerance)}};
  }
  root["holes_by_width"] = Json::array();
  for (std::size_t i = 0; i < kWidths.size(); ++i) {
    root["holes_by_width"].push_back({{"from", kWidths[i]},
                                      {"to", i + 1 < kWidths.size() ? Json(kWidths[i + 1]) : Json()},
                                      {"true", evaluation.holes[i].all},
                                      {"found", evaluation.holes[i].found}});
  }
  root["true_loops"] = Json::array();
  for (std::size_t i = 0; i < truth.loops.size(); ++i) {
    const TrueMatch& match = evaluation.loops.true_loops[i];
    const LoopSize size = size_of(truth.loops[i], truth.positions);
    const auto& kind = truth.loops[i].kind;
    root["true_loops"].push_back({{"name", or_null(name_of(truth.loops[i]))},
                                  {"kind", kind ? Json(name_of(*kind)) : Json()},
                                  {"vertices", truth.loops[i].vertices.size()},
                                  {"perimeter", size.perimeter},
                                  {"diameter", size.diameter},
                                  {"width", or_null(truth.hole_widths[i])},
                                  {"centre", {size.centre.x(), size.centre.y(), size.centre.z()}},
                                  {"counts", match.counts},
                                  {"found_by", or_null(match.found_by)}});
  }
  root["loop_matches"] = Json::array();
  for (std::size_t i = 0; i < result.loops.size(); ++i) {
    const LoopMatch& match = evaluation.loops.loops[i];
    root["loop_matches"].push_back({{"points", result.loops[i].size()},
                                    {"verdict", name_of(match.verdict)},
                                    {"true_loop", or_null(match.true_loop)},
                                    {"on_any", match.on_any},
                                    {"on", match.on},
                                    {"covered", match.covered},
                                    {"on_step", or_null(match.on_step)}});
  }
  return io::print(root, 2) + "\n";
}

// ---- Many clouds

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
