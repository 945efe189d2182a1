// SPDX-License-Identifier: Apache-2.0
// Loops read back: what `lacuna detect` writes as loops.ply, and loops as text.
#pragma once

#include "tools/matching/true_loops.hpp"

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
};

// The first line of a file of true loops begins with this text. The line is about the file and names no loop.
inline constexpr std::string_view kLoopsTextMark = "# one boundary loop per line, 0-based point ids of ";

// Reads loops with their names. In text, the comment in the line before a loop is its name, words divided by
// one blank. The name is cut to 200 bytes. Loops of a PLY file have no names.
std::vector<NamedLoopIds> read_named_loops(const std::filesystem::path& file);

// A line with a step of density begins with this text in a file of true loops; for other readers it is a
// comment.
inline constexpr std::string_view kStepMark = "#step";

// Reads the steps of density: rows of ids, in which neighbours are joined by an edge. They are closed where
// the first id is the last, too. Only text has steps. Throws `Error`.
std::vector<LoopIds> read_steps(const std::filesystem::path& file);

// Returns the ids of boundary.ply, in file order. Throws `Error`.
std::vector<std::uint64_t> read_ids(const std::filesystem::path& file);

}  // namespace lacuna::evaluation
