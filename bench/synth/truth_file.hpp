// SPDX-License-Identifier: Apache-2.0
// The file of true loops of a synthetic scan.
#pragma once

#include "bench/evaluation/loops_reader.hpp"
#include "io/read/files/output_file.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::synth {

// Each file of true loops begins with this text, by which a program recognises an earlier one.
inline constexpr std::string_view kTruthMark = evaluation::kLoopsTextMark;

// Returns `truth`, or NAME.loops.txt next to the scan if `truth` is empty. Throws `Error` if that is the scan
// itself.
std::filesystem::path truth_file_of(const std::filesystem::path& scan, const std::filesystem::path& truth);

void write_truth_head(io::OutputFile& file, const std::filesystem::path& scan);
// Writes a comment that names the loop, and a line with its ids.
void write_loop(io::OutputFile& file, const std::string& name, const std::vector<std::uint64_t>& loop);
// Writes a row that is no true loop: a comment of the mark and the ids along it, for
// evaluation::read_marked().
void write_marked(io::OutputFile& file, std::string_view mark, const std::vector<std::uint64_t>& row);

}  // namespace lacuna::synth
