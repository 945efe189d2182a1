// The file of true loops beside a made scan.
#pragma once

#include "io/results/output_file.hpp"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace lacuna::synth {

// How each file of true loops begins: an earlier one is recognised by it.
inline constexpr std::string_view kTruthMark = "# one boundary loop per line, 0-based point ids of ";

// `truth`, or beside the scan if empty, as NAME.loops.txt. Throws `Error` when that is the scan itself.
std::filesystem::path truth_file_of(const std::filesystem::path& scan, const std::filesystem::path& truth);

void write_truth_head(OutputFile& file, const std::filesystem::path& scan);
void write_loop(OutputFile& file, const std::vector<std::uint64_t>& loop);

}  // namespace lacuna::synth
