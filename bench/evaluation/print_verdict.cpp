// SPDX-License-Identifier: Apache-2.0
// The first lines of the output of `lacuna-bench evaluate`.
#include "bench/evaluation/loop_size.hpp"
#include "bench/evaluation/print.hpp"
#include "engine/model/loop.hpp"
#include "tools/console/measures_text.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::evaluation {
using namespace tools;

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

}  // namespace lacuna::evaluation
