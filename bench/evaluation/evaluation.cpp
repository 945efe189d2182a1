// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/evaluation.hpp"

#include "bench/evaluation/loop_kind.hpp"
#include "bench/evaluation/loop_order.hpp"
#include "bench/evaluation/loops_reader.hpp"
#include "bench/evaluation/mesh_boundary.hpp"
#include "bench/evaluation/mesh_reader.hpp"
#include "bench/evaluation/polylines.hpp"
#include "bench/evaluation/spacing.hpp"
#include "bench/evaluation/step_loops.hpp"
#include "engine/run/error.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/ply/ply_reader.hpp"
#include "io/read/scan/scan_pass.hpp"
#include "io/write/loops/json.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

namespace lacuna::evaluation {
using namespace io;

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kLoopsEnding = ".loops.txt";

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

Truth read_truth(const fs::path& file, std::vector<ScanInput> scans, Result& result) {
  Truth truth{.file = file};
  const bool mesh = is_ply(file);
  if (mesh && !scans.empty())
    throw Error(file.string() + ": is a mesh, its vertices are the scan; no --scan is allowed");
  const std::vector<Triangle> triangles = mesh ? read_triangles(file) : std::vector<Triangle>{};
  std::vector<NamedLoopIds> loops = mesh ? std::vector<NamedLoopIds>{} : read_named_loops(file);
  if (mesh) scans = {file};
  if (scans.empty()) scans = scans_of(file, result);
  truth.positions = read_positions(scans, result.columns);
  truth.stand_ins = stand_ins(truth.positions);
  if (mesh) {
    take_mesh(triangles, truth);
  } else {
    truth.steps = read_marked(file, kStepMark);
    for (const LoopIds& step : truth.steps) check_ids(file, step, truth);
    for (LoopIds& loop : read_marked(file, kNarrowMark))
      loops.push_back({std::move(loop), "narrow hole", true});
    take_loops(std::move(loops), truth);
  }
  add_vertices(result, truth);
  return truth;
}

MatchRule match_rule(const Truth& truth, const EvaluationRule& rule, std::span<const double> tolerances) {
  return {
      .tolerance = rule.tolerance * truth.spacing, .of_place = tolerances, .min_vertices = rule.min_vertices};
}

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
