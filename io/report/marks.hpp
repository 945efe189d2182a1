// SPDX-License-Identifier: Apache-2.0
// Marks of loops: the decision of a report's reader on each, with a note. docs/formats.md has the form of a
// file of marks. The page has the same rules in io/report/page/marks.js.
#pragma once

#include "engine/export.hpp"
#include "engine/model/loop.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

inline constexpr std::string_view kMarksSchema = "marks 1";
// "none": the loop has a note alone.
inline constexpr std::array<std::string_view, 5> kMarkNames = {"none", "real", "ignore", "scan again",
                                                               "done"};

// The loop as it was in the result for which the mark was made.
struct LoopMark {
  std::uint64_t id = 0;
  LoopKind kind = LoopKind::kHole;
  Eigen::Vector3d centroid{0, 0, 0};
  double diameter = 0;  // above 0
  std::string mark;     // one of kMarkNames
  std::string note;
};

// Reads marks in the order of the file. Throws `Error` if the file is not a file of marks.
LACUNA_API std::vector<LoopMark> read_marks(const std::filesystem::path& file);

struct MarkMatches {
  std::vector<std::optional<std::size_t>> loop_of;  // row of the scene's loops for each mark
  std::size_t by_id = 0, by_place = 0;
};

struct MatchedMarks {
  std::vector<LoopMark> marks;
  MarkMatches matches;
};

}  // namespace lacuna::io
