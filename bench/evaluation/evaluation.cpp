// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/evaluation.hpp"

#include "bench/evaluation/loops_reader.hpp"
#include "engine/run/error.hpp"
#include "io/explain/matching/nearest.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/rows/readers.hpp"
#include "io/read/scan/scan_pass.hpp"
#include "io/write/loops/json.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include <spdlog/fmt/fmt.h>

namespace lacuna::evaluation {

using namespace io;
namespace fs = std::filesystem;

// ---- The result

namespace {

double confidence_of(const Json& loop) {
  const auto found = loop.find("confidence");
  const bool is_known = found != loop.end() && found->is_number();
  return is_known ? found->get<double>() : std::numeric_limits<double>::quiet_NaN();
}

// Reads one loop at a time, and of a loop its confidence alone.
void read_report(const fs::path& file, Result& result) {
  using Event = Json::parse_event_t;
  bool is_in_loops = false;
  const auto keep = [&](int depth, Event event, const Json& parsed) {
    if (depth == 1 && event == Event::key) is_in_loops = parsed == "loops";
    if (!is_in_loops) return true;
    if (depth == 3 && event == Event::key) return parsed == "confidence";
    if (depth != 2 || event != Event::object_end) return true;
    result.confidence.push_back(confidence_of(parsed));
    return false;
  };
  const Json report = read_json(file, kResultOfDetect, keep);
  try {
    result.points = report.at("counts").at("points").get<std::uint64_t>();
    result.columns = report.value("/parameters/input/columns"_json_pointer, std::string());
    for (const Json& input : report.at("inputs")) {
      ScanInput& scan = result.inputs.emplace_back(input.at("file").get<std::string>());
      if (const auto pose = input.find("pose"); pose != input.end()) {
        const auto rows = pose->get<std::array<double, 16>>();
        scan.pose = Eigen::Matrix4d::Map(rows.data()).transpose();
      }
    }
    if (result.confidence.size() != result.loops.size() || !report.at("loops").empty()) {
      throw Error(file.string() + ": " + std::to_string(result.confidence.size()) + " loops, but " +
                  result.file.string() + " has " + std::to_string(result.loops.size()) +
                  "; both must be of one run");
    }
  } catch (const Json::exception&) {
    throw Error(file.string() + ": is not a report of lacuna detect, with counts, inputs and loops");
  }
  const auto is_unknown = [](double confidence) { return std::isnan(confidence); };
  if (std::ranges::all_of(result.confidence, is_unknown)) result.confidence.clear();
}

bool is_ply(const fs::path& file) {
  return looks_like_ply({.first_bytes = InputFile(file).peek(4)});
}

std::vector<Eigen::Vector3d> read_positions(std::vector<ScanInput> inputs, const std::string& columns) {
  const ScanFiles scan(std::move(inputs), {.columns = columns});
  ScanPass pass(scan);
  std::vector<Eigen::Vector3d> positions;
  for (PointBatch batch; pass.next(batch);) {
    positions.insert(positions.end(), batch.positions.begin(), batch.positions.end());
  }
  return positions;
}

}  // namespace

Result read_result(const fs::path& path) {
  Result result{.file = fs::is_directory(path) ? path / "loops.ply" : path};
  if (is_ply(result.file) && has_polylines(result.file)) {
    result.loops = read_polylines(result.file);
    result.vertices = read_positions({result.file}, {});
    return result;
  }
  result.loops = read_loops(result.file);
  if (!fs::is_directory(path)) return result;
  if (const fs::path file = path / "boundary.ply"; fs::exists(file)) result.boundary = read_ids(file);
  if (const fs::path file = path / "holes.json"; fs::exists(file)) read_report(file, result);
  return result;
}

// ---- The truth

namespace {

constexpr std::string_view kLoopsEnding = ".loops.txt";

std::vector<ScanInput> scans_of(const fs::path& truth, const Result& result) {
  const std::string name = truth.string();
  if (name.ends_with(kLoopsEnding)) {
    const fs::path beside = name.substr(0, name.size() - kLoopsEnding.size()) + ".ply";
    if (fs::exists(beside)) return {beside};
  }
  const auto exists = [](const ScanInput& input) { return fs::exists(input.name); };
  if (!result.inputs.empty() && std::all_of(result.inputs.begin(), result.inputs.end(), exists)) {
    return result.inputs;
  }
  throw Error(name + ": no scan of that name (X.ply beside X" + std::string(kLoopsEnding) +
              "), and none named by the result is there; --scan must name it");
}

void check_ids(const fs::path& file, std::span<const std::uint64_t> ids, const Truth& truth) {
  for (const std::uint64_t id : ids) {
    if (id < truth.positions.size()) continue;
    throw Error(file.string() + ": id " + std::to_string(id) + ", but the scan has " +
                std::to_string(truth.positions.size()) + " points, counted from 0; both must be of one scan");
  }
}

void measure_holes(const PointTree& tree, Truth& truth) {
  for (const TrueLoop& loop : truth.loops)
    truth.hole_widths.push_back(hole_width(loop, truth.positions, truth.points, tree));
}

void take_mesh(const std::vector<Triangle>& triangles, Truth& truth) {
  std::vector<bool> takes_part(truth.positions.size());
  for (const Triangle& triangle : triangles) {
    for (const std::uint64_t corner : triangle) takes_part[truth.stand_ins[corner]] = true;
  }
  truth.loops = mesh_boundary(triangles, truth.stand_ins, truth.positions);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t id = 0; id < truth.positions.size(); ++id) {
    if (takes_part[id] && truth.positions[id].allFinite()) points.push_back(truth.positions[id]);
  }
  truth.points = std::move(points);
  const PointTree tree(truth.points);
  truth.spacing = median_spacing(truth.points, tree);
  measure_holes(tree, truth);
}

void take_loops(std::vector<NamedLoopIds> named, Truth& truth) {
  std::vector<LoopIds> loops;
  for (const NamedLoopIds& loop : named) {
    check_ids(truth.file, loop.ids, truth);
    loops.push_back(loop.ids);
  }
  truth.loops = loops_through(loops, truth.stand_ins);
  truth.points = distinct_points(truth.positions, truth.stand_ins);
  const PointTree tree(truth.points);
  truth.spacing = median_spacing(truth.points, tree);
  for (std::size_t i = 0; i < named.size(); ++i) {
    truth.loops[i].name = std::move(named[i].name);
    truth.loops[i].is_narrow = named[i].is_narrow;
    truth.loops[i].kind = kind_of(loops[i], truth.positions, truth.points, tree);
  }
  measure_holes(tree, truth);
}

// The result's own vertices follow the points of the scan, each standing for itself, and its loops count
// both.
void add_vertices(Result& result, Truth& truth) {
  const std::uint64_t first = truth.positions.size();
  for (const Eigen::Vector3d& vertex : std::exchange(result.vertices, {})) {
    truth.stand_ins.push_back(truth.positions.size());
    truth.positions.push_back(vertex);
  }
  if (truth.positions.size() == first) return;
  for (LoopIds& loop : result.loops) {
    for (std::uint64_t& id : loop) id += first;
  }
}

}  // namespace

Truth read_truth(const fs::path& file, std::vector<ScanInput> scans, Result& result) {
  Truth truth{.file = file};
  const bool mesh = is_ply(file);
  if (mesh && !scans.empty())
    throw Error(file.string() + ": is a mesh, its vertices are the scan; no --scan is allowed");
  const std::vector<Triangle> triangles = mesh ? read_triangles(file) : std::vector<Triangle>{};
  TrueRows rows = mesh ? TrueRows{} : read_true_rows(file);
  if (mesh) scans = {file};
  if (scans.empty()) scans = scans_of(file, result);
  truth.positions = read_positions(scans, result.columns);
  truth.stand_ins = stand_ins(truth.positions);
  if (mesh) {
    take_mesh(triangles, truth);
  } else {
    for (const LoopIds& step : rows.steps) check_ids(file, step, truth);
    truth.steps = std::move(rows.steps);
    take_loops(std::move(rows.loops), truth);
  }
  add_vertices(result, truth);
  return truth;
}

// ---- Scores of loops

namespace {

std::optional<double> share(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

LoopScores score_loops(std::span<const LoopMatch> loops, std::span<const TrueMatch> truth) {
  LoopScores scores;
  for (const TrueMatch& loop : truth) {
    ++(loop.counts ? scores.true_loops : scores.short_loops);
    if (loop.counts) ++(loop.found_by ? scores.found : scores.missed);
  }
  scores.loops = loops.size();
  for (const LoopMatch& loop : loops) {
    scores.false_loops += loop.verdict == EdgeDecision::kFalse;
    scores.repeated += loop.verdict == EdgeDecision::kRepeated;
    scores.joined += loop.verdict == EdgeDecision::kJoined;
    scores.parted += loop.verdict == EdgeDecision::kParted;
    scores.steps += loop.verdict == EdgeDecision::kStep;
  }
  scores.recall = share(scores.found, scores.true_loops);
  const std::size_t judged = scores.loops - scores.steps;
  scores.precision = share(judged - scores.false_loops - scores.joined - scores.parted, judged);
  return scores;
}

namespace {

EdgeTree tree_of_steps(std::span<const LoopIds> steps, std::span<const Eigen::Vector3d> positions) {
  std::vector<Segment> edges;
  for (std::size_t step = 0; step < steps.size(); ++step)
    for (std::size_t i = 1; i < steps[step].size(); ++i)
      edges.push_back({positions[steps[step][i - 1]], positions[steps[step][i]], step});
  return EdgeTree(std::move(edges));
}

}  // namespace

void mark_steps(std::span<const LoopIds> loops, std::span<const LoopIds> steps,
                std::span<const TrueLoop> truth, std::span<const Eigen::Vector3d> positions,
                const MatchRule& rule, LoopAccuracy& accuracy) {
  if (steps.empty()) return;
  std::vector<TrueLoop> counting;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (accuracy.true_loops[i].counts) counting.push_back(truth[i]);
  }
  const EdgeTree step_edges = tree_of_steps(steps, positions),
                 true_edges = tree_of_truth(counting, positions);
  std::vector<std::size_t> near;
  const auto is_near = [&](const EdgeTree& edges, std::uint64_t id) {
    edges.owners_within(positions[id], rule.tolerance_at(id), near);
    return !near.empty();
  };
  for (std::size_t loop = 0; loop < loops.size(); ++loop) {
    LoopMatch& match = accuracy.loops[loop];
    if (match.verdict != EdgeDecision::kFalse) continue;
    std::size_t on_step = 0, on_either = 0;
    for (const std::uint64_t id : loops[loop]) {
      const bool is_on_step = is_near(step_edges, id);
      on_step += is_on_step;
      on_either += is_on_step || is_near(true_edges, id);
    }
    const auto points = static_cast<double>(loops[loop].size());
    match.on_step = static_cast<double>(on_step) / points;
    if (match.on_step >= rule.share) {
      match.verdict = EdgeDecision::kStep;
    } else if (static_cast<double>(on_either) / points >= rule.share) {
      match.verdict = EdgeDecision::kJoined;
    }
  }
}

std::optional<double> area_under_roc(std::span<const LoopMatch> loops, std::span<const double> confidence) {
  assert(confidence.size() == loops.size());
  struct Judged {
    double confidence;
    bool is_true;
  };
  std::vector<Judged> judged;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const EdgeDecision verdict = loops[i].verdict;
    const bool is_true = verdict == EdgeDecision::kFound || verdict == EdgeDecision::kRepeated;
    if (std::isnan(confidence[i]) || (!is_true && verdict != EdgeDecision::kFalse)) continue;
    judged.push_back({confidence[i], is_true});
  }
  std::sort(judged.begin(), judged.end(),
            [](const Judged& a, const Judged& b) { return a.confidence < b.confidence; });
  double wins = 0, false_below = 0, true_loops = 0;
  for (std::size_t i = 0, end = 0; i < judged.size(); i = end) {
    double tied_true = 0, tied_false = 0;
    for (; end < judged.size() && judged[end].confidence == judged[i].confidence; ++end) {
      ++(judged[end].is_true ? tied_true : tied_false);
    }
    wins += tied_true * (false_below + tied_false / 2);
    false_below += tied_false;
    true_loops += tied_true;
  }
  if (true_loops == 0 || false_below == 0) return std::nullopt;
  return wins / (true_loops * false_below);
}

// ---- Scores of points

namespace {

using Ids = std::vector<std::uint64_t>;
using Positions = std::span<const Eigen::Vector3d>;

std::size_t count_common(const Ids& a, const Ids& b) {
  Ids common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return common.size();
}

EdgeTree tree_of_points(const Ids& ids, Positions positions) {
  std::vector<Segment> points;
  for (const std::uint64_t id : ids) points.push_back({positions[id], positions[id], 0});
  return EdgeTree(std::move(points));
}

// Returns how many of `ids` are within their tolerance of the segments in the tree.
std::size_t count_near(const Ids& ids, const EdgeTree& tree, Positions positions, const MatchRule& rule) {
  std::size_t near = 0;
  std::vector<std::size_t> found;
  for (const std::uint64_t id : ids) {
    tree.owners_within(positions[id], rule.tolerance_at(id), found);
    near += found.empty() ? 0 : 1;
  }
  return near;
}

}  // namespace

PointScores point_scores(std::optional<double> precision, std::optional<double> recall) {
  PointScores scores{.precision = precision, .recall = recall, .f1 = std::nullopt};
  if (!precision && !recall) return scores;
  const double p = precision.value_or(0), r = recall.value_or(0);
  scores.f1 = p + r > 0 ? 2 * p * r / (p + r) : 0;
  return scores;
}

PointAccuracy score_points(std::span<const std::uint64_t> flagged, std::span<const TrueLoop> truth,
                           Positions positions, std::span<const std::uint64_t> stand_ins,
                           const MatchRule& rule) {
  Ids told, known;
  for (const std::uint64_t id : flagged) told.push_back(stand_ins[id]);
  for (const TrueLoop& loop : truth) known.insert(known.end(), loop.vertices.begin(), loop.vertices.end());
  sort_once(told);
  sort_once(known);
  const std::size_t common = count_common(told, known);
  const std::size_t right = count_near(told, tree_of_truth(truth, positions), positions, rule);
  const std::size_t met = count_near(known, tree_of_points(told, positions), positions, rule);
  return {.flagged = told.size(),
          .truth = known.size(),
          .by_id = point_scores(share(common, told.size()), share(common, known.size())),
          .within_tolerance = point_scores(share(right, told.size()), share(met, known.size()))};
}

// ---- All of them

MatchRule match_rule(const Truth& truth, const EvaluationRule& rule, std::span<const double> tolerances) {
  return {
      .tolerance = rule.tolerance * truth.spacing, .of_place = tolerances, .min_vertices = rule.min_vertices};
}

namespace {

// Returns the tolerances of the points that are compared with curves.
std::vector<double> tolerances_of_places(const Result& result, const Truth& truth, double tolerance) {
  constexpr double kOfPlace = 1.2;  // a curve of a coarser level runs up to 2.4 spacings off
  const PointTree tree(truth.points);
  std::vector<double> tolerances(truth.positions.size());
  const auto take = [&](std::span<const std::uint64_t> ids) {
    for (const std::uint64_t id : ids) {
      const Eigen::Vector3d& place = truth.positions[id];
      if (tolerances[id] == 0 && place.allFinite())
        tolerances[id] = kOfPlace * tolerance * spacing_of_place(place, tree);
    }
  };
  for (const TrueLoop& loop : truth.loops) take(loop.vertices);
  for (const LoopIds& loop : result.loops) take(loop);
  if (result.boundary) take(*result.boundary);
  return tolerances;
}

constexpr std::size_t kLeastPoints = 16;
constexpr std::size_t kMostTaken = 1 << 12;  // points whose nearest one is searched
constexpr double kSpacings = 10, kTimes = 8;

double median_edge(const LoopIds& loop, const Truth& truth) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double length =
        (truth.positions[loop[i]] - truth.positions[loop[(i + 1) % loop.size()]]).stableNorm();
    if (length >= 0) lengths.push_back(length);  // of finite points
  }
  return median(std::move(lengths));
}

double median_nearest(const LoopIds& loop, const Truth& truth) {
  std::vector<std::uint64_t> places;
  for (const std::uint64_t id : loop) {
    if (truth.positions[id].allFinite()) places.push_back(truth.stand_ins[id]);
  }
  sort_once(places);
  std::vector<Eigen::Vector3d> points;
  for (const std::uint64_t place : places) points.push_back(truth.positions[place]);
  const PointTree tree(points);
  std::vector<double> distances;
  for (std::size_t i = 0; i < points.size(); i += points.size() / kMostTaken + 1) {
    const std::vector<double> nearest = tree.nearest_distances(points[i], 2);
    if (nearest.size() == 2) distances.push_back(nearest[1]);
  }
  return median(std::move(distances));
}

// Throws `Error` at the first loop of 16 points or more whose points are in no order. Half of its edges are
// longer than 10 spacings of the scan, and than 8 times the median distance to the nearest other point. That
// ratio is 1 to 2 in a loop along a curve. Through random points, it is the root of their number. To match
// such loops takes hours, because their edges are near everything. Cost: n log n.
void check_order(const Result& result, const Truth& truth) {
  for (std::size_t i = 0; i < result.loops.size(); ++i) {
    const LoopIds& loop = result.loops[i];
    if (loop.size() < kLeastPoints) continue;
    const double edge = median_edge(loop, truth);
    if (edge <= kSpacings * truth.spacing) continue;
    const double nearest = median_nearest(loop, truth);
    if (edge <= kTimes * nearest) continue;
    throw Error(fmt::format(
        "{}: loop {} (from 0): its points are not in order along a curve: half of its {} edges are longer "
        "than "
        "{:.3g}, and the nearest points only {:.3g} apart; the ids of a loop must follow its curve",
        result.file.string(), i, loop.size(), edge, nearest));
  }
}

}  // namespace

Evaluation evaluate(const Result& result, const Truth& truth, const EvaluationRule& rule) {
  if (result.points && *result.points != truth.positions.size()) {
    throw Error(result.file.string() + ": is of a scan of " + std::to_string(*result.points) + " points, " +
                truth.file.string() + " of one of " + std::to_string(truth.positions.size()) +
                "; both must be of one scan");
  }
  for (const LoopIds& loop : result.loops) check_ids(result.file, loop, truth);
  if (result.boundary) check_ids(result.file.parent_path() / "boundary.ply", *result.boundary, truth);
  if (!result.points) check_order(result, truth);  // the loops of a run follow their curves
  Evaluation evaluation{.tolerances = tolerances_of_places(result, truth, rule.tolerance)};
  const MatchRule match = match_rule(truth, rule, evaluation.tolerances);
  evaluation.loops = match_loops(result.loops, truth.loops, truth.positions, match);
  mark_steps(result.loops, truth.steps, truth.loops, truth.positions, match, evaluation.loops);
  evaluation.scores = score_loops(evaluation.loops.loops, evaluation.loops.true_loops);
  evaluation.holes = holes_by_width(truth.hole_widths, evaluation.loops.true_loops);
  if (result.boundary)
    evaluation.boundary =
        score_points(*result.boundary, truth.loops, truth.positions, truth.stand_ins, match);
  if (!result.confidence.empty()) {
    evaluation.confidence = area_under_roc(evaluation.loops.loops, result.confidence);
  }
  return evaluation;
}

}  // namespace lacuna::evaluation
