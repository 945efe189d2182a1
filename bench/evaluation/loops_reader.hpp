// SPDX-License-Identifier: Apache-2.0
// Loops read back: what `lacuna detect` writes as loops.ply, and loops as text.
#pragma once

#include "io/explain/matching/match_loops.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::evaluation {
using namespace matching;

// Reads loops.ply in the order of its property "scalar_loop", which counts from 0 without gaps. In text, a
// line has one loop, ids divided by blanks; lines that are blank or begin with # are passed over. Returns no
// loop for a file without loops. Throws `Error`.
std::vector<LoopIds> read_loops(const std::filesystem::path& file);

struct NamedLoopIds {
  LoopIds ids;
  std::string name;  // empty without a name
  bool is_narrow = false;
};

// The first line of a file of true loops begins with this text. The line is about the file and names no loop.
inline constexpr std::string_view kLoopsTextMark = "# one boundary loop per line, 0-based point ids of ";

// Reads loops with their names. In text, the comment in the line before a loop is its name, words divided by
// one blank. The name is cut to 200 bytes. Loops of a PLY file have no names.
std::vector<NamedLoopIds> read_named_loops(const std::filesystem::path& file);

// In a file of true loops, a line of ids that is no true loop begins with one of these. Other readers take it
// for a comment. In a row of ids, neighbours are joined by an edge. A step of density is closed where its
// first id is its last, too. A hole that is too narrow to count is closed, as a true loop is.
inline constexpr std::string_view kStepMark = "#step", kNarrowMark = "#narrow";

// Reads the rows with a mark. Only text has them. Throws `Error`.
std::vector<LoopIds> read_marked(const std::filesystem::path& file, std::string_view mark);

// Returns the ids of boundary.ply, in file order. Throws `Error`.
std::vector<std::uint64_t> read_ids(const std::filesystem::path& file);

}  // namespace lacuna::evaluation
