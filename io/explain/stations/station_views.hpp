// SPDX-License-Identifier: Apache-2.0
// What a scanner saw from a place, or along a path: the directions in which it had returns, and the nearest
// range in each.
//
// Idea: directions have cells. Each of the six faces of a cube has `edge` times `edge` square ones. A path is
// cut into sections so short that all rays of a section start at one place. In the axes of the path, the
// directions in which the scanner measures are the same everywhere. So the scanner has sent a ray from a
// section to a place if the direction to the place is such a direction.
#pragma once

#include "engine/run/parallel.hpp"
#include "engine/store/sorted_runs.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/explain/stations/station.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <array>
#include <atomic>
#include <bitset>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lacuna::io {

// Faces are at right angles to the axes. So directions need no arithmetic but divisions, and have the same
// cell on every machine. The direction need not have length 1, but must not be 0.
std::size_t cell_of(const Eigen::Vector3d& direction, std::size_t edge);
Eigen::Vector3d direction_of(std::size_t cell, std::size_t edge);  // its middle, of length 1

// Radians that a cell is wide in the middle of a face; half of that at its sides.
inline double cell_angle(std::size_t edge) {
  return 2 / static_cast<double>(edge);
}

// Ranges in one direction that differ by more than this share are of two surfaces, and a ray ends at the
// first.
inline constexpr double kConflict = 0.1;

// How far the rays of a scanner spread around their mean direction. From a place far off, all points lie in
// one direction, and ranges say nothing of what is before what.
class RaySpread {
 public:
  void add(const Eigen::Vector3d& direction) {  // of length 1
    sum_ += direction;
    ++count_;
  }
  // Returns the root mean square of the angles to the mean direction, in radians; 0 without rays. It is
  // small, or an estimate.
  double angle() const;
  // Whether no scanner has so narrow a view: 4 degrees, as a square window of 10 degrees. A few rays do not
  // count.
  bool is_narrow() const;

 private:
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  std::uint64_t count_ = 0;
};

class FieldOfView {
 public:
  explicit FieldOfView(const Eigen::Vector3d& axis);
  void add(const Eigen::Vector3d& direction);
  bool contains(const Eigen::Vector3d& direction) const;  // both of length 1

  double lowest() const { return lowest_; }  // sines of the elevation; lowest > highest: nothing was added
  double highest() const { return highest_; }
  double turn() const;  // share of a whole turn around the axis

 private:
  std::size_t bin_of(const Eigen::Vector3d& direction) const;

  Eigen::Vector3d axis_, right_, forward_;
  double lowest_ = 1, highest_ = -1;
  std::bitset<512> bins_;  // around the axis, with returns
};

// Its cells are 0.11 degrees wide in the middle of a face. They lie
// in a file that has no name any more: 25 MiB, of which only touched pages take memory.
class RangeImage {
 public:
  static constexpr std::size_t kEdge = 1024;  // cells along an edge of a face
  static constexpr std::size_t kCells = 6 * kEdge * kEdge;
  static constexpr std::size_t kBytes = kCells * sizeof(float);

  RangeImage() = default;  // has no cells
  // `folder` holds the file; if it is empty, the image is in memory. Throws `Error`.
  explicit RangeImage(const std::filesystem::path& folder);

  // Keeps the smaller range, and returns the range before; 0 if there was none. The direction need not have
  // length 1, but must not be 0.
  double put(const Eigen::Vector3d& direction, double range);
  // An empty cell at most so many cells from one with a range gets the range of the nearest, within its face.
  // Among equally near cells, the first in the order of cells counts.
  void fill(std::size_t distance);

  // Returns the range in this direction; 0 if nothing came back.
  float at(const Eigen::Vector3d& direction) const { return cells()[cell_of(direction, kEdge)]; }
  std::span<const float> cells() const { return {cells_.get(), kCells}; }
  // Its pages leave memory, and come back when they are used.
  void leave_memory() const;

 private:
  struct Unmap {
    void operator()(float* cells) const;
  };
  std::unique_ptr<float[], Unmap> cells_;
};

// Returns how many cells have a range: of the image, and of ever coarser ones, each with half the edge.
inline constexpr std::size_t kCoarserImages = 7;
std::array<std::size_t, kCoarserImages> count_filled(const RangeImage& image);

// The ranges that a moving scanner measured from each place of its path, collected during the read.

// A ray from a scanner to a place, and what came back in its direction; 0: nothing.
struct Aim {
  Eigen::Vector3d eye{0, 0, 0}, direction{0, 0, 1};
  double range = 0;     // of the place
  double measured = 0;  // range of the nearest point that takes part
  double left_out = 0;  // range of the nearest point that a filter leaves out
};

class PathView {
 public:
  // Direction cells are 0.9 degrees wide. They are odd in number, so that none ends right across the path,
  // where many rays are.
  static constexpr std::size_t kEdge = 127;

  // `stated`: the file of the trajectory, for errors. `metre`: in units of the scan. Takes some 20 bytes for
  // each point in files in `folder`, and `memory` bytes.
  PathView(Trajectory path, std::filesystem::path stated, double metre, std::filesystem::path folder,
           std::uint64_t memory);

  void begin();  // forgets all points
  void add(double time, const Eigen::Vector3d& position, bool is_kept);
  // Call it once all points are there. Throws `Error` if no point has a time of the path.
  void complete();

  StationSummary summary() const;
  // Returns the share of points with a time of the path. Other points were measured from unknown places, and
  // so were all points with one time.
  double certainty() const;
  double farthest() const { return farthest_; }
  // Sections from which a part of the box is within range. A section is a hundredth of the mean range long.
  std::vector<std::uint32_t> sections_near(const Eigen::AlignedBox3d& box, double range) const;
  // Returns a ray for each group of neighbouring sections from which the scanner may have sent a ray to the
  // place. It is the ray of the section whose nearest ray is least off the place. `sections` are in order.
  std::vector<Aim> aims_at(const Eigen::Vector3d& place, std::span<const std::uint32_t> sections) const;

  std::uint64_t bytes() const { return entries_.get_deleter().bytes; }  // of a mapped file
  void leave_memory() const;
  std::uint64_t disk_bytes() const { return 2 * placed_ * sizeof(Ray); }  // in the folder, at the peak

 private:
  struct Ray {
    std::uint32_t section, cell;  // in parts; cells of points that are left out come after all others
    float range;
    auto operator<=>(const Ray&) const = default;
  };
  using Rays = SortedRuns<Ray>;
  struct Entry {
    std::uint32_t cell;
    float range;
  };
  struct Unmap {
    std::uint64_t bytes;
    void operator()(Entry* entries) const;
  };

  void store(Rays& rays);
  double coarse_step() const;
  double range_near(std::uint32_t section, std::size_t cell, bool is_left_out, std::ptrdiff_t& least) const;

  Trajectory path_;
  std::filesystem::path stated_, folder_;
  std::uint64_t memory_;
  double finest_, section_;  // lengths of a section: while points come, and of the kept sections
  double chord_;             // half of the chord between whose ends the axes are taken
  std::uint32_t last_section_ = UINT32_MAX;  // of a point, with its axes
  Eigen::Matrix3d last_axes_;
  std::optional<Rays> rays_;
  SweptDirections swept_;
  RaySpread spread_;
  FieldOfView field_{Eigen::Vector3d::UnitZ()};
  std::uint64_t points_ = 0, placed_ = 0;  // with any time, and with one of the path
  std::uint64_t conflicts_ = 0;            // placed points that lie behind others by a tenth of their range
  std::uint64_t range_sum_ = 0;            // of the placed points, in finest sections
  double first_time_ = 0, last_time_ = 0;  // of points
  double previous_time_ = 0, time_step_ = 0;  // of the last point; least difference, infinite for one time
  double farthest_ = 0;
  std::vector<std::uint64_t> first_;  // entry of each section, and the number of all
  std::unique_ptr<Entry[], Unmap> entries_{nullptr, Unmap{0}};
  std::vector<Eigen::Vector3d> eyes_;  // of each section
  std::vector<Eigen::Matrix3d> axes_;  // likewise
};

// The ranges that each station measured in each direction, collected while the run reads the scan.

struct StationView {
  Station station;
  std::string subject;          // whose points are of it, in words
  bool is_of_scan = false;      // else a list states it
  std::uint64_t points = 0;     // finite points, also the ones that a filter leaves out
  std::uint64_t conflicts = 0;  // at ranges that differ by a tenth from others in their directions
  double farthest = 0;          // range of a point
  double step = 0;              // mean angle between rays, radians
  double one_range = 0;         // StationSummary::one_range
  RaySpread spread;
  FieldOfView field{station.axis};
  RangeImage ranges;                   // of points that take part
  std::optional<RangeImage> left_out;  // of points that a filter leaves out; empty if there are none

  // A single sweep has one range in most directions. The share of points for which this holds; below
  // `kLeastCertain` the station did not measure them. It is 0 for a view that is too narrow to say, unless
  // the scan itself states the station, as a range camera does.
  double certainty() const;
  static constexpr double kLeastCertain = StationSummary::kLeastCertain;
};

// Without ranges there are summaries alone. They take no disk space, and leave certainty and steps open.
enum class Ranges : std::uint8_t { kKept, kNone };

// A file states the stations, or the path of a moving scanner. Else the scans have them: E57 and PTX, PCD
// with a viewpoint, PLY with a camera, and files with a pose. Each image is a file of 25 MiB in the folder.
class StationViews final : public RowObserver {
 public:
  // `stated` is that file; it may be empty. The scan must outlive the views. `folder` is empty if files are
  // in memory. Throws `Error`.
  StationViews(const ScanFiles& scan, const std::filesystem::path& stated, std::filesystem::path folder,
               Ranges ranges = Ranges::kKept);

  void begin() override;
  void take(std::size_t file, const ScanReader& reader, const RowBatch& rows,
            std::span<const Eigen::Vector3d> read, std::span<const Eigen::Vector3d> kept) override;
  // Throws `Error` where a file states the stations, and none of them has a point.
  void end() override;

  // Completes the views, in the order of the file, or of the scans. Reads the scan if no pass over it has
  // ended yet. Call it once.
  std::span<const StationView> complete(const TaskArena& arena);
  std::span<const StationView> views() const { return views_; }  // once complete
  const PathView* path() const { return path_.get(); }           // null if no scanner moves
  // Notes that so many places of images were touched. Their pages leave memory where they may be more than
  // the scan's reader may hold.
  void note_touched(std::uint64_t places) const;
  std::vector<StationSummary> summaries() const;  // of a path alone, or of the views
  const PointsOfNone& points_of_none() const { return of_none_; }
  std::uint64_t disk_bytes() const;  // that a run takes for them in the folder

 private:
  StationView* find(std::size_t file, std::uint64_t source);
  std::string subject_of(std::uint64_t file, std::uint64_t source) const;
  void add(Station station);
  RangeImage empty_image() const;
  void add_scanners(std::size_t file, const ScanReader& reader);
  void put(StationView& view, const Eigen::Vector3d& position, bool is_kept);

  const ScanFiles& scan_;
  std::filesystem::path folder_;
  std::uint64_t memory_;                            // of pages of images
  mutable std::atomic<std::uint64_t> touched_ = 0;  // places of images, since the pages last left memory
  std::filesystem::path stated_;                    // file of stations; empty: the scan has them
  bool is_complete_ = false, has_ranges_;
  std::unique_ptr<PathView> path_;
  std::vector<StationView> views_;
  PointsOfNone of_none_;
  // The key is file and source, kAny for any of them.
  static constexpr std::uint64_t kAny = UINT64_MAX;
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::size_t> index_;
  std::size_t file_ = SIZE_MAX;     // of the last batch
  std::size_t scanners_known_ = 0;  // of that file
};

// Returns the views that a pass over the scan is to have as its observer. Returns null where no station can
// be known: the config states no file, and no scan names a scanner. Throws `Error`.
std::unique_ptr<StationViews> watch_stations(const ScanFiles& scan, const OutputConfig& config,
                                             const std::filesystem::path& folder,
                                             Ranges ranges = Ranges::kKept);

}  // namespace lacuna::io
