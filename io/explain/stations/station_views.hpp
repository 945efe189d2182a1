// SPDX-License-Identifier: Apache-2.0
// The ranges that each station measured in each direction, collected while the run reads the scan.
#pragma once

#include "engine/run/parallel.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/explain/stations/directions.hpp"
#include "io/explain/stations/path_view.hpp"
#include "io/explain/stations/station.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lacuna::io {

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
