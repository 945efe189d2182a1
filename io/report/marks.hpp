// SPDX-License-Identifier: Apache-2.0
// Marks of loops: what a reader of a report decides about each, with a note. docs/formats.md has the form of
// a file of them. The page has the same rules in io/report/page/marks.js.
#pragma once

#include "io/report/scene.hpp"
#include "io/results/json.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

inline constexpr std::string_view kMarksSchema = "marks 1";
// "none": the loop has a note alone.
inline constexpr std::array<std::string_view, 5> kMarkNames = {"none", "real", "ignore", "scan again",
                                                               "done"};

// The loop as it was in the result that the mark was made for.
struct LoopMark {
  std::uint64_t id = 0;
  LoopKind kind = LoopKind::kHole;
  Eigen::Vector3d centroid{0, 0, 0};
  double diameter = 0;  // above 0
  std::string mark;     // one of kMarkNames
  std::string note;
};

// In the order of the file. Throws `Error` where the file is not a file of marks.
std::vector<LoopMark> read_marks(const std::filesystem::path& file);

struct MarkMatches {
  std::vector<std::optional<std::size_t>> loop_of;  // row of the scene's loops for each mark
  std::size_t by_id = 0, by_place = 0;
};

// Finds marks again in a result with other ids. A mark and its loop have one kind, and a loop has one mark.
// 1. In the order of marks: the loop with its id, if its centroid is no farther than the smaller diameter.
// 2. Of the others, the nearest pairs first: centroids are within half of the mark's diameter, and the
//    diameters differ by a factor of 1.5 at most. Equally near ones go in the order of marks, then of loops.
// Cost: the number of marks times that of loops.
MarkMatches match_marks(std::span<const LoopMark> marks, const Scene::Loops& loops);

struct MatchedMarks {
  std::vector<LoopMark> marks;
  MarkMatches matches;
};

// What the page reads: ids, marks and notes of matched loops, and the others as they were in the file.
Json marks_json(const MatchedMarks& marks, const Scene::Loops& loops);

}  // namespace lacuna::io
