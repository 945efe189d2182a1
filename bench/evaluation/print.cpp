// SPDX-License-Identifier: Apache-2.0
// print: the output of `lacuna-bench evaluate` and `lacuna-bench score`, for people and as JSON.
#include "bench/evaluation/evaluation.hpp"
#include "engine/model/loop.hpp"
#include "io/write/loops/json.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include <Eigen/Geometry>
#include <spdlog/fmt/fmt.h>

namespace lacuna::evaluation {

using namespace tools;
using io::Json;

namespace {

// What is said of loops that are decided so, as docs/evaluate.md defines it.
struct Words {
  std::string_view name;          // in the JSON
  std::string_view of_loop;       // of one that matches no true loop; empty for others
  std::string_view one, several;  // the line that counts them
};
constexpr Words kWords[] = {
    {"found"},
    {"repeated", "", "loop repeats a found one", "loops repeat found ones"},
    {"short", "", "true loop is too short (--min-vertices) or too narrow to count",
     "true loops are too short (--min-vertices) or too narrow to count"},
    {"joined", "joined with", "loop joins true loops, or one with other places",
     "loops join true loops, or one with other places"},
    {"parted", "part of", "loop follows a part of a true loop", "loops follow parts of true loops"},
    {"step", "step of density", "loop follows a step of density, with points on both sides",
     "loops follow steps of density, with points on both sides"},
    {"false", "false"}};
const Words& words_of(EdgeDecision verdict) {
  return kWords[static_cast<std::size_t>(verdict)];
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json json_of(const PointScores& scores) {
  return {{"precision", or_null(scores.precision)},
          {"recall", or_null(scores.recall)},
          {"f1", or_null(scores.f1)}};
}

std::string print_tally(const Tally& tally) {
  return print_count(tally.found) + " of " + print_count(tally.all);
}

// ---- One result, for people

constexpr std::size_t kMostRows = 40;
constexpr const char* kUnit = "";  // files of true loops have none

// True loops that are counted together: each kind by itself, or all where kinds are not known.
struct Group {
  std::optional<LoopKind> kind;
  const char *one, *several;
};

std::vector<Group> groups_of(const std::vector<TrueLoop>& loops) {
  const bool knows_kinds =
      !loops.empty() &&
      std::all_of(loops.begin(), loops.end(), [](const TrueLoop& loop) { return loop.kind.has_value(); });
  if (!knows_kinds) return {{{}, "true loop", "true loops"}};
  return {{LoopKind::kHole, "hole", "holes"}, {LoopKind::kOuter, "outer curve", "outer curves"}};
}

std::string print_sentence(const EvaluationText& text) {
  const LoopScores& scores = text.evaluation.scores;
  std::string line = "found ";
  for (const Group& group : groups_of(text.truth.loops)) {
    Tally tally;
    for (std::size_t i = 0; i < text.truth.loops.size(); ++i) {
      const TrueMatch& match = text.evaluation.loops.true_loops[i];
      if (!match.counts || (group.kind && text.truth.loops[i].kind != group.kind)) continue;
      ++tally.all;
      tally.found += match.found_by.has_value();
    }
    if (group.kind == LoopKind::kOuter && tally.all == 0) continue;
    if (group.kind == LoopKind::kOuter) line += " and ";
    line += print_count(tally.found) + " of " + counted(tally.all, group.one, group.several);
  }
  line += ", " + print_count(scores.false_loops) + " false\n";
  const auto add = [&line](std::size_t count, EdgeDecision verdict) {
    const Words& words = words_of(verdict);
    if (count > 0) line += "  " + counted(count, words.one, words.several) + "\n";
  };
  add(scores.joined, EdgeDecision::kJoined);
  add(scores.parted, EdgeDecision::kParted);
  add(scores.repeated, EdgeDecision::kRepeated);
  add(scores.steps, EdgeDecision::kStep);
  add(scores.short_loops, EdgeDecision::kShort);
  return line;
}

using Rows = std::vector<std::vector<std::string>>;

std::string print_widths(const HolesByWidth& holes) {
  Rows rows = {{"width of holes, local spacings"}, {"found"}};
  std::size_t all = 0;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    const std::string from = print_count(kWidths[i]);
    const std::string to = i + 1 < holes.size() ? print_count(kWidths[i + 1]) : "";
    rows[0].push_back(to.empty() ? from + " and more" : i == 0 ? "below " + to : from + " to " + to);
    rows[1].push_back(print_tally(holes[i]));
    all += holes[i].all;
  }
  return all == 0 ? "" : "\n" + print_table(rows);
}

struct LoopLine {
  std::string what;
  LoopSize size;
  std::size_t points;
  std::string verdict;
  bool is_missed = false;
};

// Prints a table, large loops first. For loops beyond the table, it prints their number, and how many true
// ones are missed.
std::string print_loops(std::vector<LoopLine> lines, const char* title, const char* verdict, bool are_true,
                        double extent) {
  if (lines.empty()) return "";
  std::stable_sort(lines.begin(), lines.end(),
                   [](const LoopLine& a, const LoopLine& b) { return a.size.perimeter > b.size.perimeter; });
  Rows rows = {{title, "perimeter", "diameter", "centre", "points", verdict}};
  std::size_t missed_beyond = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const LoopLine& line = lines[i];
    if (i >= kMostRows) {
      missed_beyond += line.is_missed;
      continue;
    }
    rows.push_back({line.what, print_length(line.size.perimeter, kUnit),
                    print_length(line.size.diameter, kUnit), print_place(line.size.centre, extent),
                    print_count(line.points), line.verdict});
  }
  std::string table = "\n" + print_table(rows);
  if (lines.size() <= kMostRows) return table;
  table += "  and " + print_count(lines.size() - kMostRows) + " more";
  if (are_true) table += ", " + print_count(missed_beyond) + " of them missed: --json has them all";
  return table + "\n";
}

std::string title_of(const Truth& truth, std::size_t loop) {
  const std::string& name = truth.loops[loop].name;
  return name.empty() ? "true loop " + std::to_string(loop) : visible(name);
}

std::string print_true_loops(const EvaluationText& text, const Group& group, double extent) {
  const Truth& truth = text.truth;
  std::vector<LoopLine> lines;
  for (std::size_t i = 0; i < truth.loops.size(); ++i) {
    const TrueLoop& loop = truth.loops[i];
    if (group.kind && loop.kind != group.kind) continue;
    const TrueMatch& match = text.evaluation.loops.true_loops[i];
    lines.push_back({.what = title_of(truth, i),
                     .size = size_of(loop, truth.positions),
                     .points = loop.vertices.size(),
                     .verdict = match.found_by ? "loop " + std::to_string(*match.found_by)
                                : match.counts ? "missed"
                                               : "too short or narrow",
                     .is_missed = match.counts && !match.found_by});
  }
  return print_loops(std::move(lines), group.one, "found by", true, extent);
}

// Prints the loops that match no true loop.
std::string print_others(const EvaluationText& text, double extent) {
  std::vector<LoopLine> lines;
  for (std::size_t i = 0; i < text.result.loops.size(); ++i) {
    const LoopMatch& match = text.evaluation.loops.loops[i];
    std::string verdict(words_of(match.verdict).of_loop);
    if (verdict.empty()) continue;
    const bool is_along = match.verdict == EdgeDecision::kJoined || match.verdict == EdgeDecision::kParted;
    if (is_along && match.true_loop) verdict += " " + title_of(text.truth, *match.true_loop);
    const LoopIds& loop = text.result.loops[i];
    lines.push_back({.what = "loop " + std::to_string(i),
                     .size = size_of(loop, text.truth.positions),
                     .points = loop.size(),
                     .verdict = std::move(verdict)});
  }
  return print_loops(std::move(lines), "loops that match none", "what it is", false, extent);
}

}  // namespace

std::string print_verdict(const EvaluationText& text) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : text.truth.positions) {
    if (position.allFinite()) box.extend(position);
  }
  const double extent = box.isEmpty() ? 0 : box.sizes().maxCoeff();
  std::string all = print_sentence(text) + print_widths(text.evaluation.holes);
  for (const Group& group : groups_of(text.truth.loops)) all += print_true_loops(text, group, extent);
  return all + print_others(text, extent);
}

// ---- One result, as JSON

std::string print_json(const EvaluationText& text) {
  const auto& [result, truth, evaluation, result_path, truth_path, rule] = text;
  const LoopScores& scores = evaluation.scores;
  Json root = {{"result", result_path.string()},
               {"truth", truth_path.string()},
               {"points", truth.positions.size()},
               {"spacing", truth.spacing},
               {"tolerance", rule.tolerance},
               {"min_vertices", rule.min_vertices},
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
               {"boundary", nullptr},
               {"holes_by_width", Json::array()},
               {"true_loops", Json::array()},
               {"loop_matches", Json::array()}};
  if (const auto& boundary = evaluation.boundary) {
    root["boundary"] = {{"flagged", boundary->flagged},
                        {"true", boundary->truth},
                        {"by_id", json_of(boundary->by_id)},
                        {"within_tolerance", json_of(boundary->within_tolerance)}};
  }
  for (std::size_t i = 0; i < kWidths.size(); ++i) {
    root["holes_by_width"].push_back({{"from", kWidths[i]},
                                      {"to", i + 1 < kWidths.size() ? Json(kWidths[i + 1]) : Json()},
                                      {"true", evaluation.holes[i].all},
                                      {"found", evaluation.holes[i].found}});
  }
  for (std::size_t i = 0; i < truth.loops.size(); ++i) {
    const TrueLoop& loop = truth.loops[i];
    const TrueMatch& match = evaluation.loops.true_loops[i];
    const LoopSize size = size_of(loop, truth.positions);
    root["true_loops"].push_back({{"name", loop.name.empty() ? Json() : Json(loop.name)},
                                  {"kind", loop.kind ? Json(name_of(*loop.kind)) : Json()},
                                  {"vertices", loop.vertices.size()},
                                  {"perimeter", size.perimeter},
                                  {"diameter", size.diameter},
                                  {"width", or_null(truth.hole_widths[i])},
                                  {"centre", {size.centre.x(), size.centre.y(), size.centre.z()}},
                                  {"counts", match.counts},
                                  {"found_by", or_null(match.found_by)}});
  }
  for (std::size_t i = 0; i < result.loops.size(); ++i) {
    const LoopMatch& match = evaluation.loops.loops[i];
    root["loop_matches"].push_back({{"points", result.loops[i].size()},
                                    {"verdict", words_of(match.verdict).name},
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

// `value_of`: a member, or a function of a score.
template <class Value>
auto sum(Clouds clouds, const Value& value_of) {
  std::decay_t<std::invoke_result_t<Value, const CloudScore&>> total{};
  for (const CloudScore& cloud : clouds) total += std::invoke(value_of, cloud);
  return total;
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

// The scores of some clouds together, as the JSON has them.
Json figures_of(Clouds clouds) {
  const auto tally = [&](Tally CloudScore::*of) -> Json {
    return {{"true", sum(clouds, [&](const CloudScore& c) { return (c.*of).all; })},
            {"found", sum(clouds, [&](const CloudScore& c) { return (c.*of).found; })}};
  };
  const auto area = [&](double HoleAreas::*part) {
    return sum(clouds, [&](const CloudScore& c) { return c.areas.*part; });
  };
  const auto points = [&](std::size_t PointAccuracy::*count) {
    return sum(clouds, [&](const CloudScore& c) { return c.points.*count; });
  };
  const double truth = area(&HoleAreas::truth), covered = area(&HoleAreas::covered);
  const double found = area(&HoleAreas::found), right = area(&HoleAreas::right);
  return {{"clouds", clouds.size()},
          {"holes", tally(&CloudScore::holes)},
          {"outer_curves", tally(&CloudScore::outer_curves)},
          {"false", sum(clouds, &CloudScore::false_loops)},
          {"repeated", sum(clouds, &CloudScore::repeated)},
          {"joined_or_parted", sum(clouds, &CloudScore::joined_or_parted)},
          {"areas",
           {{"true", truth},
            {"covered", covered},
            {"found", found},
            {"right", right},
            {"completeness", or_null(share(covered, truth))},
            {"correctness", or_null(share(right, found))}}},
          {"points",
           {{"true", points(&PointAccuracy::truth)},
            {"flagged", points(&PointAccuracy::flagged)},
            {"all", json_of(point_scores(pooled(clouds, &PointAccuracy::flagged, &PointScores::precision),
                                         pooled(clouds, &PointAccuracy::truth, &PointScores::recall)))},
            {"median", json_of({.precision = median(clouds, &PointScores::precision),
                                .recall = median(clouds, &PointScores::recall),
                                .f1 = median(clouds, &PointScores::f1)})}}}};
}

using NamedFigures = std::vector<std::pair<std::string, Json>>;

// Those of each kind; those of all clouds come last.
NamedFigures figures_of(const ScoresByKind& kinds) {
  NamedFigures named;
  std::vector<CloudScore> all;
  for (const auto& [name, clouds] : kinds) {
    named.emplace_back(name, figures_of(clouds));
    all.insert(all.end(), clouds.begin(), clouds.end());
  }
  named.emplace_back("all", figures_of(all));
  return named;
}

// A column of the tables, and where the JSON has its figures. The first one of a table is its title.
struct Column {
  const char *title, *figure;
};
const std::vector<Column> kTables[] = {
    {{"per hole", ""},
     {"clouds", "/clouds"},
     {"holes found", "/holes"},
     {"outer curves found", "/outer_curves"},
     {"false loops", "/false"},
     {"joined or parted", "/joined_or_parted"}},
    {{"per area", ""}, {"completeness", "/areas/completeness"}, {"correctness", "/areas/correctness"}},
    {{"per point", ""},
     {"precision", "/points/all/precision"},
     {"recall", "/points/all/recall"},
     {"F1", "/points/all/f1"},
     {"median precision", "/points/median/precision"},
     {"median recall", "/points/median/recall"},
     {"median F1", "/points/median/f1"}}};

std::string print_figure(const Json& figure) {
  if (figure.is_null()) return "-";
  if (figure.is_object()) return print_tally({.found = figure["found"], .all = figure["true"]});
  return figure.is_number_float() ? fmt::format("{:.3f}", figure.get<double>()) : print_count(figure);
}

}  // namespace

std::string print_scores(const ScoresByKind& kinds) {
  const NamedFigures named = figures_of(kinds);
  std::string text;
  for (const std::vector<Column>& columns : kTables) {
    Rows rows(1);
    for (const Column& column : columns) rows[0].emplace_back(column.title);
    for (const auto& [kind, figures] : named) {
      auto& row = rows.emplace_back(1, visible(kind));
      for (const Column& column : std::span(columns).subspan(1))
        row.push_back(print_figure(figures.at(Json::json_pointer(column.figure))));
    }
    text += (text.empty() ? "" : "\n") + print_table(rows);
  }
  return text;
}

std::string print_json(const ScoresByKind& kinds, const ScoredFolders& folders) {
  Json root = {{"clouds", folders.clouds.string()},   {"results", folders.results.string()},
               {"tolerance", folders.rule.tolerance}, {"min_vertices", folders.rule.min_vertices},
               {"without_result", Json::array()},     {"groups", Json::object()}};
  for (const auto& cloud : folders.without_result) root["without_result"].push_back(cloud.stem().string());
  NamedFigures named = figures_of(kinds);
  root["all"] = std::move(named.back().second);
  named.pop_back();
  for (auto& [name, figures] : named) root["groups"][name] = std::move(figures);
  return io::print(root, 2) + "\n";
}

}  // namespace lacuna::evaluation
