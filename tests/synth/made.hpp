// Made scans, read back: the vocabulary of the tests of `lacuna synth`.
#pragma once

#include "tools/synth/scanner.hpp"
#include "tools/synth/surface.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace lacuna::synth {

using Position = std::array<float, 3>;

// A folder that goes away with the test.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "lacuna-synth-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::filesystem::path operator/(const char* name) const { return path_ / name; }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::uint64_t fnv1a(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

// The rows of a PLY as bytes, all of `stride`; fails the test when header and size disagree.
inline std::vector<std::string> rows_of(const std::filesystem::path& file, std::size_t stride) {
  const std::string bytes = bytes_of(file);
  const std::size_t body = bytes.find("end_header\n") + 11;
  const std::size_t count = std::stoull(bytes.substr(bytes.find("element vertex ") + 15));
  if (bytes.size() != body + count * stride) throw std::runtime_error("the header's count is not the rows'");
  std::vector<std::string> rows;
  for (std::size_t row = 0; row < count; ++row) rows.push_back(bytes.substr(body + row * stride, stride));
  return rows;
}

template <typename T>
T scalar(const std::string& row, std::size_t offset) {
  T value;
  std::memcpy(&value, row.data() + offset, sizeof value);
  return value;
}

inline std::vector<Position> positions_of(const std::filesystem::path& file, std::size_t stride = 12) {
  std::vector<Position> positions;
  for (const std::string& row : rows_of(file, stride))
    positions.push_back({scalar<float>(row, 0), scalar<float>(row, 4), scalar<float>(row, 8)});
  return positions;
}

inline std::vector<std::vector<std::uint64_t>> loops_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::vector<std::uint64_t>> loops;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    loops.emplace_back(std::istream_iterator<std::uint64_t>(words), std::istream_iterator<std::uint64_t>());
  }
  return loops;
}

inline double distance(const Position& a, const Position& b) {
  return std::hypot(double(a[0]) - b[0], double(a[1]) - b[1], double(a[2]) - b[2]);
}

inline SurfaceOptions small_surface(const Folder& folder, SurfaceKind kind = SurfaceKind::kPlane) {
  SurfaceOptions options;
  options.out = folder / "made.ply";
  options.truth = folder / "made.loops.txt";
  options.kind = kind;
  options.points = 20'000;
  options.holes = 5;
  options.hole_radius = {3, 7};
  return options;
}

inline std::size_t rims_of(SurfaceKind kind) {
  if (kind == SurfaceKind::kTorus) return 0;
  return kind == SurfaceKind::kCylinder ? 2 : 1;
}

inline constexpr std::array kAllKinds{SurfaceKind::kPlane, SurfaceKind::kWaves, SurfaceKind::kCylinder,
                                      SurfaceKind::kTorus, SurfaceKind::kSphereCap};

}  // namespace lacuna::synth
