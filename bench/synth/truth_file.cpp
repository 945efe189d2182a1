// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/truth_file.hpp"

#include "engine/run/error.hpp"

namespace lacuna::synth {
using namespace io;

namespace fs = std::filesystem;

namespace {

std::string line_of(const std::vector<std::uint64_t>& ids) {
  std::string line;
  for (const std::uint64_t id : ids) line += std::to_string(id) + ' ';
  line.back() = '\n';
  return line;
}

}  // namespace

fs::path truth_file_of(const fs::path& scan, const fs::path& truth) {
  const fs::path file = truth.empty() ? fs::path(scan).replace_extension(".loops.txt") : truth;
  if (fs::weakly_canonical(file) == fs::weakly_canonical(scan))
    throw UsageError(file.string() + ": the scan and its true loops need two files");
  return file;
}

void write_truth_head(OutputFile& file, const fs::path& scan) {
  file.write(std::string(kTruthMark) + scan.filename().string() + "\n");
}

void write_loop(OutputFile& file, const std::string& name, const std::vector<std::uint64_t>& loop) {
  file.write("# " + name + "\n" + line_of(loop));
}

void write_marked(OutputFile& file, std::string_view mark, const std::vector<std::uint64_t>& row) {
  file.write(std::string(mark) + " " + line_of(row));
}

}  // namespace lacuna::synth
