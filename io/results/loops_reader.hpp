// Loops read back: what `lacuna detect` writes as loops.ply, and loops as text.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace lacuna {

using LoopIds = std::vector<std::uint64_t>;  // closed, in the order of its edges, at least one id

// loops.ply: in the order of its property "scalar_loop", which counts from 0 without gaps. Text: one loop per
// line, ids divided by blanks; lines that are blank or begin with # are passed over. A file without loops
// gives none. Throws `Error`.
std::vector<LoopIds> read_loops(const std::filesystem::path& file);

// The ids of boundary.ply, in file order. Throws `Error`.
std::vector<std::uint64_t> read_ids(const std::filesystem::path& file);

}  // namespace lacuna
