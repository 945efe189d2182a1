// SPDX-License-Identifier: Apache-2.0
#include "io/report/match_marks.hpp"

#include <algorithm>
#include <tuple>
#include <unordered_map>

namespace lacuna::io {
namespace {

constexpr double kMostSizes = 1.5;  // of two diameters of one hole, the larger over the smaller

struct Pair {
  double distance = 0;
  std::size_t mark = 0, loop = 0;
};

bool are_of_one_size(double a, double b) {
  return a <= kMostSizes * b && b <= kMostSizes * a;
}

Json entry_json(const LoopMark& mark) {
  return {{"id", mark.id},
          {"kind", name_of(mark.kind)},
          {"centroid", list(mark.centroid)},
          {"diameter", mark.diameter},
          {"mark", mark.mark},
          {"note", mark.note}};
}

}  // namespace

MarkMatches match_marks(std::span<const LoopMark> marks, const Scene::Loops& loops) {
  MarkMatches matches;
  matches.loop_of.resize(marks.size());
  std::vector<bool> is_taken(loops.ids.size());
  const auto distance = [&](std::size_t mark, std::size_t loop) {
    return (marks[mark].centroid - loops.measures[loop].centroid).norm();
  };
  const auto match = [&](std::size_t mark, std::size_t loop) {
    matches.loop_of[mark] = loop;
    is_taken[loop] = true;
  };

  std::unordered_map<std::uint64_t, std::size_t> loop_with;
  for (std::size_t loop = 0; loop < loops.ids.size(); ++loop) loop_with.emplace(loops.ids[loop], loop);
  for (std::size_t mark = 0; mark < marks.size(); ++mark) {
    const auto found = loop_with.find(marks[mark].id);
    if (found == loop_with.end() || is_taken[found->second]) continue;
    const LoopMeasures& loop = loops.measures[found->second];
    const double near = std::min(marks[mark].diameter, loop.diameter);
    if (loop.kind != marks[mark].kind || !(distance(mark, found->second) <= near)) continue;
    match(mark, found->second);
    ++matches.by_id;
  }

  std::vector<Pair> pairs;
  for (std::size_t mark = 0; mark < marks.size(); ++mark) {
    if (matches.loop_of[mark]) continue;
    for (std::size_t loop = 0; loop < loops.ids.size(); ++loop) {
      const LoopMeasures& measures = loops.measures[loop];
      if (is_taken[loop] || measures.kind != marks[mark].kind) continue;
      if (!are_of_one_size(marks[mark].diameter, measures.diameter)) continue;
      const double away = distance(mark, loop);
      if (away <= marks[mark].diameter / 2) pairs.push_back({away, mark, loop});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.distance, a.mark, a.loop) < std::tie(b.distance, b.mark, b.loop);
  });
  for (const Pair& pair : pairs) {
    if (matches.loop_of[pair.mark] || is_taken[pair.loop]) continue;
    match(pair.mark, pair.loop);
    ++matches.by_place;
  }
  return matches;
}

Json marks_json(const MatchedMarks& marks, const Scene::Loops& loops) {
  Json ids = Json::array(), names = Json::array(), notes = Json::array(), others = Json::array();
  for (std::size_t i = 0; i < marks.marks.size(); ++i) {
    const LoopMark& mark = marks.marks[i];
    if (const auto loop = marks.matches.loop_of[i]) {
      ids.push_back(loops.ids[*loop]);
      names.push_back(mark.mark);
      notes.push_back(mark.note);
    } else {
      others.push_back(entry_json(mark));
    }
  }
  return {{"id", ids}, {"mark", names}, {"note", notes}, {"unmatched", others}};
}

}  // namespace lacuna::io
