// SPDX-License-Identifier: Apache-2.0
// evaluation: compares a result with the truth. Files in, scores out.
//
// Idea: a found loop is right where its points lie near the edges of one true loop, and along most of it.
// Where points are far apart, near is farther. What is neither right nor wrong, such as loops along steps of
// density, is counted apart.
//
// Source: docs/evaluate.md. Cost: n log n, for points and edges.
#pragma once

#include "bench/evaluation/measures.hpp"
#include "io/explain/matching/match_loops.hpp"
#include "io/read/scan/scan_files.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna::evaluation {

using namespace matching;

// ---- What is compared

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

// Reads the output folder of a run: loops.ply, and boundary.ply and holes.json if they exist. Or reads a file
// of loops: loops.ply, text, or lines of a PLY file (loops_reader.hpp). Throws `Error`.
Result read_result(const std::filesystem::path& path);

// Reads a PLY mesh, whose boundary is the truth, or a file of loops as text, whose ids count the points of
// `scans`. Without `scans`, they count the points of X.ply next to X.loops.txt. If there is no X.ply, they
// count the points of the result's inputs, if these still exist. Points that no face of a mesh uses take no
// part in the spacing. The vertices of the result become `positions` behind the points of the scan, and its
// loops count them there. Throws `Error`.
Truth read_truth(const std::filesystem::path& file, std::vector<io::ScanInput> scans, Result& result);

struct EvaluationRule {
  // Spacings of the scan. Where points are farther apart, 1.2 times as many spacings of the place
  // (spacing_of_place).
  double tolerance = 2;
  std::size_t min_vertices = 8;
};

// ---- Scores of loops

struct LoopScores {
  std::size_t true_loops = 0, found = 0, missed = 0;  // of the true loops that count
  std::size_t short_loops = 0;                        // true ones that do not count
  std::size_t loops = 0, false_loops = 0, repeated = 0, joined = 0, parted = 0, steps = 0;
  std::optional<double> recall;  // share of the true ones that are found; empty without true ones
  std::optional<double>
      precision;  // neither false, joined nor parted of the loops but steps; empty without such loops
};

LoopScores score_loops(std::span<const LoopMatch> loops, std::span<const TrueMatch> true_loops);

// The probability that a loop that matches a true one has a higher confidence than a false one, ties being
// half. This is the area under the ROC curve. Loops without a confidence (NaN) take no part, and neither do
// loops that are neither right nor wrong (short, joined, parted, step). There is no value where
// either kind is missing.
std::optional<double> area_under_roc(std::span<const LoopMatch> loops, std::span<const double> confidence);

// A false loop becomes a step if `share` of its points are within the tolerance of the edges of steps. It
// becomes joined if `share` of its points are near these edges or a true loop that counts. Without steps,
// nothing changes. Cost: n log n.
void mark_steps(std::span<const LoopIds> loops, std::span<const LoopIds> steps,
                std::span<const TrueLoop> truth, std::span<const Eigen::Vector3d> positions,
                const MatchRule& rule, LoopAccuracy& accuracy);

// ---- Scores of points, as boundary points

struct PointScores {
  std::optional<double> precision;  // share of the flagged that are right; empty if nothing is flagged
  std::optional<double> recall;     // share of the true that are flagged; empty if nothing is true
  std::optional<double> f1;         // their harmonic mean; empty if nothing is flagged or true
};

// Returns both, and F1. A part that is empty counts as 0 in F1.
PointScores point_scores(std::optional<double> precision, std::optional<double> recall);

struct PointAccuracy {
  std::size_t flagged = 0, truth = 0;  // places
  PointScores by_id;                   // flagged and true at the same place
  PointScores within_tolerance;        // a flagged place counts near a true edge, a true one near a flagged
};

// Points at one place count once. The true points are the vertices of all loops given. Within the tolerance
// of the rule, the loops' edges count instead, since a boundary is a curve. Where few points of a curve were
// sampled, places between them are on it as well.
PointAccuracy score_points(std::span<const std::uint64_t> flagged, std::span<const TrueLoop> truth,
                           std::span<const Eigen::Vector3d> positions,
                           std::span<const std::uint64_t> stand_ins, const MatchRule& rule);

// ---- All of them

struct Evaluation {
  LoopAccuracy loops;
  LoopScores scores;
  std::vector<double> tolerances;  // lengths, of the points of all curves and of flagged points, by id
  std::optional<PointAccuracy> boundary;
  std::optional<double> confidence;  // area under the ROC curve
  HolesByWidth holes;
};

// Returns the rule by which curves match: the tolerance of the scan, and `tolerances` of places.
MatchRule match_rule(const Truth& truth, const EvaluationRule& rule, std::span<const double> tolerances);

// Throws `Error` if the result is of another scan: it has ids, or a number of points, that the truth does not
// have. Throws, too, if the points of a loop are in no order.
Evaluation evaluate(const Result& result, const Truth& truth, const EvaluationRule& rule);

}  // namespace lacuna::evaluation
