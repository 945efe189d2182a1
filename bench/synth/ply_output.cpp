// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/ply_output.hpp"

#include "io/read/files/number.hpp"

#include <array>
#include <span>

namespace lacuna::synth {
using namespace io;

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

void PlyOutput::add(Vec3 position) {
  std::array<std::byte, 24> row;
  std::byte* end = row.data();
  store_position(end, position, coordinates_);
  file_.write(std::span(row.data(), end));
  ++count_;
}

void PlyOutput::add(Vec3 position, std::uint8_t scan, float intensity, double time) {
  std::array<std::byte, 40> row;
  std::byte* end = row.data();
  store_position(end, position, coordinates_);
  store_next(end, scan);
  store_next(end, intensity);
  if (extras_ == Extras::kScanAndTime) store_next(end, time);
  file_.write(std::span(row.data(), end));
  ++count_;
}

void PlyOutput::finish() {
  file_.overwrite_start(header());
}

}  // namespace lacuna::synth
