// SPDX-License-Identifier: Apache-2.0
// Synthetic scans, read back: the vocabulary of the tests of `lacuna-bench synth`.
#pragma once

#include "bench/evaluation/loops_reader.hpp"
#include "bench/synth/scan.hpp"
#include "bench/synth/surface.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::synth {

using Position = std::array<float, 3>;

using evaluation::read_loops;
using test::at;
using test::read_file;

inline std::uint64_t fnv1a(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

// `options` make a scan, and after `change` are refused in one line that leaves no file.
template <typename Options, typename Summary, typename Change>
void check_refused(const ScratchFolder& folder, Options options, Summary (*write)(const Options&),
                   const Change& change) {
  change(options);
  const std::string reason = test::error_of([&] { write(options); });
  CHECK(!reason.empty());
  CHECK(reason.find('\n') == std::string::npos);
  CHECK(folder.names().empty());
}

// The rows of a PLY as bytes; fails the test when header and size disagree. Rows have `stride` bytes, and
// those of moving scanners a time behind them.
inline std::vector<std::string> rows_of(const fs::path& file, std::size_t stride) {
  const std::string bytes = read_file(file);
  const std::size_t body = bytes.find("end_header\n") + 11;
  const std::size_t count = std::stoull(bytes.substr(bytes.find("element vertex ") + 15));
  if (bytes.substr(0, body).find(" gps_time\n") != bytes.npos) stride += sizeof(double);
  if (bytes.size() != body + count * stride) throw std::runtime_error("the header's count is not the rows'");
  std::vector<std::string> rows;
  for (std::size_t row = 0; row < count; ++row) rows.push_back(bytes.substr(body + row * stride, stride));
  return rows;
}

inline std::vector<Position> positions_of(const fs::path& file, std::size_t stride = 12) {
  std::vector<Position> positions;
  for (const std::string& row : rows_of(file, stride))
    positions.push_back({at<float>(row, 0), at<float>(row, 4), at<float>(row, 8)});
  return positions;
}

// The points of each loop, whatever the order of the points in the file.
inline std::multiset<std::set<Position>> places_of(const std::vector<matching::LoopIds>& loops,
                                                   const std::vector<Position>& points) {
  std::multiset<std::set<Position>> all;
  for (const auto& loop : loops) {
    std::set<Position> places;
    for (const std::uint64_t id : loop) places.insert(points[id]);
    all.insert(places);
  }
  return all;
}

inline double distance(const Position& a, const Position& b) {
  return std::hypot(double(a[0]) - b[0], double(a[1]) - b[1], double(a[2]) - b[2]);
}

inline SurfaceOptions small_surface(const ScratchFolder& folder, SurfaceKind kind = SurfaceKind::kPlane) {
  return {.out = folder / "made.ply",
          .truth = folder / "made.loops.txt",
          .kind = kind,
          .points = 20'000,
          .holes = 5,
          .hole_radius = {3, 7}};
}

inline std::size_t rims_of(SurfaceKind kind) {
  if (kind == SurfaceKind::kTorus || kind == SurfaceKind::kSphere || kind == SurfaceKind::kCube) return 0;
  return kind == SurfaceKind::kCylinder ? 2 : 1;
}

inline constexpr std::array kAllKinds{SurfaceKind::kPlane, SurfaceKind::kWaves,     SurfaceKind::kCylinder,
                                      SurfaceKind::kTorus, SurfaceKind::kSphereCap, SurfaceKind::kSphere,
                                      SurfaceKind::kCube};
inline constexpr std::array kAllScenes{SceneKind::kRoom,  SceneKind::kCourt,  SceneKind::kHall,
                                       SceneKind::kVault, SceneKind::kStreet, SceneKind::kPlant,
                                       SceneKind::kAerial};
inline constexpr std::array kAllPositions{PositionKind::kJittered, PositionKind::kRandom};

}  // namespace lacuna::synth
