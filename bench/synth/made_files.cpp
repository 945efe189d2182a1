// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/made_files.hpp"

#include "engine/run/error.hpp"
#include "io/read/files/number.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <unordered_map>

namespace lacuna::synth {

using namespace io;

namespace fs = std::filesystem;

void require(bool holds, const std::string& message) {
  if (!holds) throw UsageError(message);
}

namespace {

constexpr std::size_t kCountWidth = 20;  // digits of 2^64 - 1

void store_position(std::byte*& to, Vec3 p, Coordinates coordinates) {
  for (const double coordinate : {p.x, p.y, p.z}) {
    if (coordinates == Coordinates::kDouble) {
      store_next(to, coordinate);
    } else {
      store_next(to, static_cast<float>(coordinate));
    }
  }
}

}  // namespace

PlyOutput::PlyOutput(OutputFile& file, Coordinates coordinates, Extras extras)
    : file_(file), coordinates_(coordinates), extras_(extras) {
  file_.write(header());
}

// The header has one length for every count: the comment takes the digits that the count leaves.
std::string PlyOutput::header() const {
  const std::string count = std::to_string(count_);
  const std::string type = coordinates_ == Coordinates::kDouble ? "double" : "float";
  std::string text = std::string(kScanMark) + std::string(kCountWidth - count.size() + 1, '-') +
                     "\nelement vertex " + count + "\n";
  for (const char* axis : {" x\n", " y\n", " z\n"}) text += "property " + type + axis;
  if (extras_ != Extras::kNone) text += "property uchar scan\nproperty float intensity\n";
  if (extras_ == Extras::kScanAndTime) text += "property double gps_time\n";
  return text + "end_header\n";
}

void PlyOutput::add(Vec3 position, std::uint8_t scan, float intensity, double time) {
  std::array<std::byte, 40> row;
  std::byte* end = row.data();
  store_position(end, position, coordinates_);
  if (extras_ != Extras::kNone) {
    store_next(end, scan);
    store_next(end, intensity);
  }
  if (extras_ == Extras::kScanAndTime) store_next(end, time);
  file_.write(std::span(row.data(), end));
  ++count_;
}

void PlyOutput::finish() {
  file_.overwrite_start(header());
}

namespace {

// Cuts the shorter part out of a loop that visits a point twice; false if it visits none twice.
bool cut_return(NumberLoop& loop) {
  std::unordered_map<std::uint64_t, std::size_t> visited;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto [first, is_new] = visited.emplace(loop[i], i);
    if (is_new) continue;
    const auto begin = loop.begin() + static_cast<std::ptrdiff_t>(first->second);
    const auto end = loop.begin() + static_cast<std::ptrdiff_t>(i);
    if (2 * (i - first->second) <= loop.size())
      loop.erase(begin, end);
    else
      loop = NumberLoop(begin, end);
    return true;
  }
  return false;
}

}  // namespace

NumberLoop without_returns(NumberLoop loop) {
  while (cut_return(loop)) {
  }
  return loop;
}

void to_canonical(NumberLoop& ids) {
  std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
  if (ids.back() < ids[1]) std::reverse(ids.begin() + 1, ids.end());
}

fs::path truth_file_of(const fs::path& scan, const fs::path& truth) {
  const fs::path file = truth.empty() ? fs::path(scan).replace_extension(".loops.txt") : truth;
  if (fs::weakly_canonical(file) == fs::weakly_canonical(scan))
    throw UsageError(file.string() + ": the scan and its true loops need two files");
  return file;
}

void write_truth(OutputFile& file, const fs::path& scan, const evaluation::TrueRows& rows) {
  file.write(std::string(kTruthMark) + scan.filename().string() + "\n");
  const auto write_row = [&file](const std::string& head, const NumberLoop& ids) {
    std::string line = head;
    for (const std::uint64_t id : ids) line += std::to_string(id) + ' ';
    line.back() = '\n';
    file.write(line);
  };
  for (const auto& [ids, name, is_narrow] : rows.loops)
    write_row(is_narrow ? std::string(evaluation::kNarrowMark) + " " : "# " + name + "\n", ids);
  for (const NumberLoop& step : rows.steps) write_row(std::string(evaluation::kStepMark) + " ", step);
}

}  // namespace lacuna::synth
