// SPDX-License-Identifier: Apache-2.0
// Compares a result with the truth: files in, scores out.
#pragma once

#include "bench/evaluation/boundary_points.hpp"
#include "bench/evaluation/hole_width.hpp"
#include "bench/evaluation/loop_scores.hpp"
#include "io/explain/matching/match_loops.hpp"
#include "io/read/scan/scan_files.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna::evaluation {
using namespace matching;

// The result of a program. Ids are ranks of points of the scan; the ids of polylines are places in
// `vertices`.
struct Result {
  std::filesystem::path file;  // with the loops
  std::vector<LoopIds> loops;
  std::vector<Eigen::Vector3d> vertices;               // of polylines, which need not be points of the scan
  std::vector<double> confidence;                      // of each loop, NaN if unknown; may be empty
  std::optional<std::vector<std::uint64_t>> boundary;  // flagged points
  std::optional<std::uint64_t> points;                 // of the input; this and the next from the report
  std::vector<io::ScanInput> inputs;
  std::string columns;  // of inputs that are text
};

// The true loops. Ids are places in `positions`.
struct Truth {
  std::filesystem::path file;
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::uint64_t> stand_ins;
  std::vector<Eigen::Vector3d> points;  // the places that take part: distinct, finite
  std::vector<TrueLoop> loops;
  std::vector<std::optional<double>> hole_widths;  // of each loop; see hole_width()
  std::vector<LoopIds> steps;                      // of density; see kStepMark
  double spacing = 0;                              // median, over `points`
};

struct EvaluationRule {
  // Spacings of the scan. Where points are farther apart, 1.2 times as many spacings of the place
  // (spacing_of_place).
  double tolerance = 2;
  std::size_t min_vertices = 8;
};

struct Evaluation {
  LoopAccuracy loops;
  LoopScores scores;
  std::vector<double> tolerances;  // lengths, of the points of all curves and of flagged points, by id
  std::optional<PointAccuracy> boundary;
  std::optional<double> confidence;  // area under the ROC curve
  HolesByWidth holes;
};

// Reads the output folder of a run: loops.ply, and boundary.ply and holes.json if they exist. Or reads a file
// of loops: loops.ply, text, or lines of a PLY file (polylines.hpp). Throws `Error`.
Result read_result(const std::filesystem::path& path);

// Reads a PLY mesh, whose boundary is the truth, or a file of loops as text, whose ids count the points of
// `scans`. Without `scans`, they count the points of X.ply next to X.loops.txt. If there is no X.ply, they
// count the points of the result's inputs, if these still exist. Points that no face of a mesh uses take no
// part in the spacing. The vertices of the result become `positions` behind the points of the scan, and its
// loops count them there. Throws `Error`.
Truth read_truth(const std::filesystem::path& file, std::vector<io::ScanInput> scans, Result& result);

// Returns the rule by which curves match: the tolerance of the scan, and `tolerances` of places.
MatchRule match_rule(const Truth& truth, const EvaluationRule& rule, std::span<const double> tolerances);

// Throws `Error` if the result is of another scan: it has ids, or a number of points, that the truth does not
// have. Throws, too, if the points of a loop are in no order.
Evaluation evaluate(const Result& result, const Truth& truth, const EvaluationRule& rule);

}  // namespace lacuna::evaluation
