// SPDX-License-Identifier: Apache-2.0
// The ranges that a moving scanner measured from each place of its path, collected during the read.
//
// Idea: the path is cut into sections so short that all rays of a section start at one place. In the axes of
// the path, the directions in which the scanner measures are the same everywhere. So the scanner has sent a
// ray from a section to a place if the direction to the place is such a direction.
#pragma once

#include "engine/store/sorted_runs.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/explain/stations/directions.hpp"
#include "io/explain/stations/trajectory.hpp"

#include <compare>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {

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

}  // namespace lacuna::io
