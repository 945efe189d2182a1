// SPDX-License-Identifier: Apache-2.0
// evaluation: compares a result with the truth, of one scan and of many. Files in, scores out, and their
// text.
//
// Idea: a found loop is right where its points lie near the edges of one true loop, and along most of it.
// Where points are far apart, near is farther. What is neither right nor wrong, such as loops along steps of
// density, is counted apart.
//
// Source: docs/evaluate.md. Cost: n log n, for points and edges.
#pragma once

#include "engine/model/loop.hpp"
#include "io/explain/matching/match_loops.hpp"
#include "io/explain/matching/nearest.hpp"
#include "io/read/scan/scan_files.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
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

// ---- Measures: how far apart points are, and how large loops

// Returns the spacing of a place, also where it is sampled in lines. An even sampling of this spacing has its
// 32nd neighbour as far away. Returns 0 where there are no more than 32 points. Cost: log n.
double spacing_of_place(const Eigen::Vector3d& place, const PointTree& tree);

// Returns the median over the points; 0 for fewer than two. The points are finite and distinct. If there are
// more than 130,000 points, the function takes as many, evenly spread. Cost: n log n, for the tree.
// `tree` has these points.
double median_spacing(std::span<const Eigen::Vector3d> points, const PointTree& tree);

double median(std::vector<double> values);  // the upper one of two; 0 without values

// In units of the scan.
struct LoopSize {
  double perimeter = 0;             // sum of the edges' lengths
  double diameter = 0;              // largest distance between two vertices
  double area = 0;                  // projected along its normal; of an open loop: closed over its centre
  Eigen::Vector3d centre{0, 0, 0};  // mean of the vertices
};

// Ids are places in `positions`, which are finite there. A loop without edges has a size of 0.
LoopSize size_of(const TrueLoop& loop, std::span<const Eigen::Vector3d> positions);
LoopSize size_of(const LoopIds& loop, std::span<const Eigen::Vector3d> positions);

// Returns whether a true loop goes around a hole or around a piece of surface.
// Uses the rule for found loops (engine/loops/measure_loop.hpp): the surface is where the means of the 15
// nearest points are. `points` are the points of the tree, and ids are places in `positions`. Returns nothing
// for fewer than three ids.
std::optional<LoopKind> kind_of(const LoopIds& loop, std::span<const Eigen::Vector3d> positions,
                                std::span<const Eigen::Vector3d> points, const PointTree& tree);

// ---- How many true holes are found, by their width: how small a hole a program finds

// Returns the width of a hole, 2 area / perimeter, in local spacings: the mean distance of its vertices to
// their 4 nearest other points. `points` are the points of the tree, and
// the vertices are among them. Returns nothing for an outer curve, and for a loop without a kind or a
// spacing. A loop of a mesh gets its kind from kind_of().
std::optional<double> hole_width(const TrueLoop& loop, std::span<const Eigen::Vector3d> positions,
                                 std::span<const Eigen::Vector3d> points, const PointTree& tree);

struct Tally {
  std::size_t found = 0, all = 0;
};

// Spacings. A class of widths begins at one of these, and ends before the next; the last one has no end.
inline constexpr std::array kWidths = {0u, 2u, 3u, 5u, 10u};
using HolesByWidth = std::array<Tally, kWidths.size()>;

// Counts the true loops that count and have a width, by class. Both spans are in the order of the true loops.
HolesByWidth holes_by_width(std::span<const std::optional<double>> widths,
                            std::span<const TrueMatch> matches);

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

// ---- Scores of a cloud, per hole, per area and per point

// In squares of the unit of the scan.
// Completeness is covered / truth, and correctness right / found.
struct HoleAreas {
  double truth = 0, covered = 0;  // of the true holes that count, and the part of it near found holes
  double found = 0, right = 0;    // of the found holes, and the part of it near true holes, counting or not
};

struct CloudScore {
  Tally holes, outer_curves;    // that count
  std::size_t false_loops = 0;  // with those that match a true loop which another loop has found
  std::size_t repeated = 0;     // these alone
  std::size_t joined_or_parted = 0;
  HoleAreas areas;       // squares of the spacing
  PointAccuracy points;  // the boundary points where the result has them, else the points of the loops
};

// Loops along steps of density are neither right nor wrong: they have no area and
// no points. Points of true loops that do not count are right if they are flagged, and not missed otherwise.
// Throws `Error` as evaluate() does.
CloudScore score_cloud(const Result& result, const Truth& truth, const EvaluationRule& rule);

// ---- What is printed of one result

struct EvaluationText {
  const Result& result;
  const Truth& truth;
  const Evaluation& evaluation;
  std::filesystem::path result_path, truth_path;
  EvaluationRule rule;
};

// Prints one sentence with the numbers of found and false loops, and the holes found by width. Then it prints
// a line for each true loop, the largest first, with its name, size, place, and what found it. Then it prints
// a line for each loop that matches no true loop.
std::string print_verdict(const EvaluationText& text);

// Returns all scores, and every number behind them, by loop.
std::string print_json(const EvaluationText& text);

// ---- And of many clouds

// By kind of cloud. There is at least one kind, and each has a cloud.
using ScoresByKind = std::map<std::string, std::vector<CloudScore>>;

// What was scored, for the JSON.
struct ScoredFolders {
  std::filesystem::path clouds, results;
  std::vector<std::filesystem::path> without_result;
  EvaluationRule rule;
};

// Prints three tables, per hole, per area and per point. Each has a row for each kind, and one for all.
std::string print_scores(const ScoresByKind& kinds);
// Returns every number of the tables, and those behind them.
std::string print_json(const ScoresByKind& kinds, const ScoredFolders& folders);

}  // namespace lacuna::evaluation
