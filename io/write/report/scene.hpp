// SPDX-License-Identifier: Apache-2.0
// The content of a report and a picture: a sample of the scan and the loops, from the folder of a run's
// results. And what both leave out of it, as a roof hides all else from above.
#pragma once

#include "io/explain/stations/cause.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/write/loops/json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

// Positions are relative to `origin`: single precision keeps 2^-24 of the scan's extent. Strays (holes.json
// names them) are left out, and so are the vertices of loops through strays: these loops have none.
struct Scene {
  Json holes;                       // holes.json without its loops
  Json next_stations;               // of read_next_stations(); null without
  Eigen::AlignedBox3d bounds;       // of the scan without its strays; empty without points
  std::uint64_t strays = 0;         // points of the scan that lie outside of them
  Eigen::Vector3d origin{0, 0, 0};  // least corner of the bounds
  double edge = 1;                  // of the cube from there that holds everything; above 0
  double rounding = 0;              // bound on the error of local coordinates (--local-coordinates)
  float highest = std::numeric_limits<float>::infinity();  // pictures have nothing above; from the origin

  struct Points {
    std::vector<Eigen::Vector3f> positions;
    std::vector<float> probabilities;      // one for each position, from 0 to 1
    std::vector<Eigen::Vector3f> normals;  // of the same points; unit, unoriented; 0 where undefined
    std::vector<Colour> colours;           // of the same points; empty where the scan has none
    float spacing = 0;                     // typical distance of neighbours
  } points;

  std::string compared;  // the earlier result of a comparison; empty without one
  struct Loops {
    std::vector<std::uint64_t> ids;       // as in holes.json
    std::vector<ExplainedLoop> measures;  // of each
    std::vector<std::size_t> first;       // of its vertices; one more at the end
    std::vector<Eigen::Vector3f> vertices;
    std::uint64_t all = 0;  // reported by the run
    // In a comparison, what has become of each loop, and its ids in the earlier result; else empty.
    std::vector<std::string> changes, earlier;

    std::span<const Eigen::Vector3f> vertices_of(std::size_t loop) const {
      return std::span(vertices).subspan(first[loop], first[loop + 1] - first[loop]);
    }
  } loops;

  // Returns a place in coordinates of the scan.
  Eigen::Vector3d place(const Eigen::Vector3f& position) const { return origin + position.cast<double>(); }
};

struct SceneLimits {
  std::size_t positions = 1'000'000;  // points and vertices of loops together; a quarter at most of loops
  std::size_t loops = 10'000;
  std::size_t all_loops = std::numeric_limits<std::size_t>::max();  // of the run; more are an error
};

// Returns limits by which a scene fits in so many bytes, most of which are for reading.
SceneLimits limits_within(std::uint64_t memory);

// Reads holes.json, sample.ply and loops.ply of `folder`. Without a sample.ply, the scene has loops
// alone. Beyond the limits, points are left out evenly, and loops with the smallest perimeters. Loops are in
// the order of their ids. Throws `Error` where a file is missing or not as `lacuna detect` writes it. Memory:
// up to 40 bytes for each position and 150 for each loop of the run.
Scene read_scene(const std::filesystem::path& folder, const SceneLimits& limits = {});

// Makes the cube of the scene hold these places, too.
void extend(Scene& scene, const Eigen::AlignedBox3d& places);

// Reads the next stations of next_stations.geojson in `folder`, as {rank, place, area, share} in its order;
// null if the file is not there. It is apart from read_scene(), since `lacuna stations` replaces a damaged
// file. Throws `Error` if the file is not as that command writes it.
Json read_next_stations(const std::filesystem::path& folder);

// Returns the value at a share of all values, in ascending order. `share` is from 0 to 1. There is at least
// one value; the order of the values changes. Cost: linear.
inline float percentile(std::vector<float>& values, double share) {
  const auto at = values.begin() + std::llround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Returns the narrowest range of this share of the values, with 0.15 of it more on both sides. The range
// ends where the values end. The function sorts them; there is at least one.
inline constexpr double kFramed = 0.98;
std::pair<float, float> most_of(std::vector<float>& values, double share);

// The colours of points as the scan has them: red, green and blue of any type, or grey by intensity.
class ColourColumns {
 public:
  explicit ColourColumns(const RowLayout& layout);

  void load(const RowBatch& rows);
  void take(std::size_t row);  // of the batch that was loaded last
  void begin_file();           // the rows that are taken from now on are of another file

  // Returns one colour for each row taken; none if the layout has no colours. Values of a file have 16 bits
  // if any is above 255, as some programs write bytes there. Floats up to 1, or hardly more, are shares.
  // Intensities are stretched from their 2nd to their 98th percentile, of all files.
  std::vector<Colour> finish() const;

 private:
  const RowLayout& layout_;
  std::vector<const Property*> properties_;  // three, one or none
  std::vector<std::vector<double>> loaded_;  // of each
  std::vector<float> taken_;                 // row by row
  std::vector<std::size_t> files_ = {0};     // of each file, the first in taken_
};

// Returns the heights below which a view sees into each storey, in coordinates of the scan, the highest
// first. They are none without ceilings. A ceiling is level, and covers at least as much as lies open. Below
// it are empty 0.15 of all heights. Cost: linear.
std::vector<double> ceiling_cuts(const Scene& scene);

// Whether each loop is narrower than `LoopEvidence::kSmallWidth` spacings of its place, twice its area over
// its perimeter. Pages and pictures fold such loops into one line where there are `kLeastSmall` or more; else
// none is small.
inline constexpr std::ptrdiff_t kLeastSmall = 20;
std::vector<bool> small_loops(const Scene::Loops& loops);

}  // namespace lacuna::io
