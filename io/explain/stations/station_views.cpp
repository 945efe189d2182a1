// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/station_views.hpp"

#include "engine/model/points.hpp"
#include "engine/run/error.hpp"
#include "io/read/crs/crs.hpp"
#include "io/read/rows/column_rules.hpp"
#include "io/read/rows/columns.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace lacuna::io {
namespace {

constexpr std::size_t kNoted = 1024;   // rows, after which memory is checked
constexpr double kLeastFilled = 0.85;  // of the quarters of cells with returns
constexpr int kBitsOfStep = 13;        // of a float, within a thousandth of it

const Property* time_of(const RowLayout& layout) {
  std::vector<std::string> names;
  for (const Property& property : layout.properties) names.push_back(property.name);
  const auto found = find_time(names);
  return found ? &layout.properties[*found] : nullptr;
}

// Fills the directions between rays, as far as rays lie from each other. That is the edge of cells so coarse
// that almost all quarters of a cell have a range where the cell has one.
void fill_between_rays(StationView& view) {
  const auto filled = count_filled(view.ranges);
  std::size_t coarser = 0;
  const auto share = [&](std::size_t i) {
    return static_cast<double>(filled[i]) / static_cast<double>(4 * filled[i + 1]);
  };
  while (coarser + 2 < filled.size() && share(coarser) < kLeastFilled) ++coarser;
  const auto cells = static_cast<double>(RangeImage::kCells >> (2 * coarser));
  const double solid_angle = 4 * std::numbers::pi * static_cast<double>(filled[coarser]) / cells;
  view.step = std::sqrt(solid_angle / static_cast<double>(view.points));
  if (coarser == 0) return;
  view.ranges.fill(std::size_t{1} << coarser);
  if (view.left_out) view.left_out->fill(std::size_t{1} << coarser);
}

// Returns the range of a twentieth of the rays or more, and ten times as many as next to it; else 0. The
// counts are of ranges in steps of a thousandth, by the first bits of their numbers.
double one_range_of(const std::map<std::uint32_t, std::size_t>& counts) {
  constexpr std::size_t kLeastShare = 20, kBeside = 10;
  std::size_t all = 0;
  for (const auto& [step, count] : counts) all += count;
  const auto count_in = [&](std::uint32_t from, std::uint32_t to) {
    std::size_t sum = 0;
    for (auto at = counts.lower_bound(from); at != counts.end() && at->first < to; ++at) sum += at->second;
    return sum;
  };
  for (const auto& [step, count] : counts) {
    const std::size_t here = count_in(step, step + 2);  // a range near the end of a step is in two
    if (kLeastShare * here >= all && kBeside * (count_in(step - 2, step + 4) - here) <= here)
      return std::bit_cast<float>((step + 1) << kBitsOfStep);
  }
  return 0;
}

// Every fourth cell of each row and column counts: 0.4 degrees are enough.
void find_field(StationView& view) {
  std::map<std::uint32_t, std::size_t> counts;
  constexpr std::size_t kEdge = RangeImage::kEdge, kStep = 4;
  const std::span<const float> ranges = view.ranges.cells();
  for (std::size_t row = 0; row < 6 * kEdge; row += kStep) {
    for (std::size_t cell = row * kEdge; cell < (row + 1) * kEdge; cell += kStep) {
      if (ranges[cell] > 0) ++counts[std::bit_cast<std::uint32_t>(ranges[cell]) >> kBitsOfStep];
      if (ranges[cell] > 0 || (view.left_out && view.left_out->cells()[cell] > 0))
        view.field.add(direction_of(cell, kEdge));
    }
  }
  view.one_range = one_range_of(counts);
}

StationSummary summary_of(const StationView& view) {
  return {.name = view.station.name,
          .subject = view.subject,
          .place = view.station.place,
          .points = view.points,
          .certainty = view.certainty(),
          .spread = view.spread.angle(),
          .lowest = view.points > 0 ? view.field.lowest() : 0,
          .highest = view.points > 0 ? view.field.highest() : 0,
          .turn = view.field.turn(),
          .step = view.step,
          .farthest = view.farthest,
          .one_range = view.one_range};
}

}  // namespace

double StationView::certainty() const {
  if (points == 0 || (spread.is_narrow() && !is_of_scan)) return 0;
  return 1 - static_cast<double>(conflicts) / static_cast<double>(points);
}

StationViews::StationViews(const ScanFiles& scan, const std::filesystem::path& stated,
                           std::filesystem::path folder, Ranges ranges)
    : scan_(scan),
      folder_(std::move(folder)),
      memory_(scan.memory()),
      stated_(stated),
      has_ranges_(ranges == Ranges::kKept) {
  if (stated.empty()) return;
  if (std::optional<Trajectory> path = read_trajectory(stated, memory_)) {
    for (const ScanFile& file : scan.files()) {
      if (!time_of(file.layout))
        throw Error(file.name.string() + ": has no column gps_time or time, which a trajectory needs");
    }
    const double metre = 1 / metres_of_unit(scan.length_unit()).value_or(1);
    path_ = std::make_unique<PathView>(std::move(*path), stated, metre, folder_, memory_);
    return;
  }
  for (Station& station : read_stations(stated, names_of(scan), layouts_of(scan))) add(std::move(station));
}

void StationViews::add(Station station) {
  const auto key = std::pair(station.file ? *station.file : kAny, station.source ? *station.source : kAny);
  if (!index_.emplace(key, views_.size()).second) return;
  views_.push_back({.station = std::move(station),
                    .subject = subject_of(key.first, key.second),
                    .is_of_scan = stated_.empty(),
                    .ranges = empty_image()});
}

void StationViews::add_scanners(std::size_t file, const ScanReader& reader) {
  if (file != file_) scanners_known_ = 0;
  file_ = file;
  const std::vector<ScannerPose> scanners = reader.scanners();
  for (; scanners_known_ < scanners.size(); ++scanners_known_) {
    const ScannerPose& scanner = scanners[scanners_known_];
    const std::string number = scanner.source ? " " + std::to_string(*scanner.source) : "";
    add({.name = scan_.files()[file].name.stem().string() + number,
         .place = scanner.place,
         .axis = scanner.axis,
         .file = file,
         .source = scanner.source});
  }
}

RangeImage StationViews::empty_image() const {
  return has_ranges_ ? RangeImage(folder_) : RangeImage();
}

StationView* StationViews::find(std::size_t file, std::uint64_t source) {
  for (const auto& key : {std::pair(std::uint64_t{file}, source), std::pair(std::uint64_t{file}, kAny),
                          std::pair(kAny, source), std::pair(kAny, kAny)}) {
    if (const auto found = index_.find(key); found != index_.end()) return &views_[found->second];
  }
  return nullptr;
}

// Returns the words for points of a file, and of a number.
std::string StationViews::subject_of(std::uint64_t file, std::uint64_t source) const {
  const std::string number = source == kAny ? "" : "number " + std::to_string(source);
  if (file == kAny) return number;
  return (number.empty() ? "" : number + " of ") + scan_.files()[file].name.string();
}

void StationViews::begin() {
  if (is_complete_) return;
  file_ = SIZE_MAX;
  of_none_ = {};
  if (path_) path_->begin();
  for (StationView& view : views_) {
    view.points = view.conflicts = 0;
    view.spread = {};
  }
}

void StationViews::put(StationView& view, const Eigen::Vector3d& position, bool is_kept) {
  const Eigen::Vector3d arm = position - view.station.place;
  const double range = arm.norm();
  if (!(range > 0) || !arm.allFinite()) return;
  view.spread.add(arm.stableNormalized());
  if (range > kFarthest) {
    ++view.points;
    ++view.conflicts;
    return;
  }
  if (!is_kept && !view.left_out) view.left_out = empty_image();
  RangeImage& image = is_kept ? view.ranges : *view.left_out;
  ++view.points;
  view.farthest = std::max(view.farthest, range);
  if (!has_ranges_) return view.field.add(arm / range);
  const double before = image.put(arm, range);
  if (before > 0 && std::fabs(range - before) > kConflict * std::min(range, before)) ++view.conflicts;
}

void StationViews::take(std::size_t file, const ScanReader& reader, const RowBatch& rows,
                        std::span<const Eigen::Vector3d> read, std::span<const Eigen::Vector3d> kept) {
  if (is_complete_) return;
  if (path_) {
    std::vector<double> times;
    load_column(rows, reader.layout().stride, *time_of(reader.layout()), times);
    for (std::size_t i = 0; i < rows.count; ++i) path_->add(times[i], read[i], !std::isnan(kept[i].x()));
    return;
  }
  if (stated_.empty()) add_scanners(file, reader);
  const std::vector<double> sources = sources_of(rows, reader.layout());
  std::uint64_t source = kAny;
  StationView* view = find(file, kAny);
  double last = -1;
  for (std::size_t i = 0; i < rows.count; ++i) {
    if (!sources.empty() && sources[i] != last) {
      last = sources[i];
      source = last >= 0 && last < 0x1p32 ? static_cast<std::uint64_t>(last) : kAny;
      view = find(file, source);
    }
    if (view) {
      put(*view, read[i], !std::isnan(kept[i].x()));
    } else if (read[i].allFinite() && of_none_.points++ == 0) {
      of_none_.subject = subject_of(file, source);
    }
    if (i % kNoted == kNoted - 1) note_touched(kNoted);
  }
}

void StationViews::note_touched(std::uint64_t places) const {
  constexpr std::uint64_t kPage = 4096;
  const std::uint64_t images = views_.size() * RangeImage::kBytes + (path_ ? path_->bytes() : 0);
  touched_ += places;
  if (std::min(touched_ * kPage, images) <= memory_) return;
  touched_ = 0;
  if (path_) path_->leave_memory();
  for (const StationView& view : views_) {
    view.ranges.leave_memory();
    if (view.left_out) view.left_out->leave_memory();
  }
}

void StationViews::end() {
  is_complete_ = true;
  const auto has_points = [](const StationView& view) { return view.points > 0; };
  if (stated_.empty() || path_ || of_none_.points == 0 || std::ranges::any_of(views_, has_points)) return;
  const StationView& first = views_.front();
  throw Error(stated_.string() + ": no station has a point: " + first.station.name + " has those of " +
              first.subject + ", and the scan has points of " + of_none_.subject);
}

std::span<const StationView> StationViews::complete(const TaskArena& arena) {
  if (!is_complete_) read_all(scan_, *this);
  if (path_) path_->complete();
  if (!has_ranges_) return views_;
  const std::vector<std::uint64_t> needs(views_.size(), 2 * RangeImage::kBytes);
  arena.for_each_within_budget(needs, memory_, [&](std::size_t i) {
    if (views_[i].points == 0) return;
    fill_between_rays(views_[i]);
    find_field(views_[i]);
    views_[i].ranges.leave_memory();
    if (views_[i].left_out) views_[i].left_out->leave_memory();
  });
  return views_;
}

std::vector<StationSummary> StationViews::summaries() const {
  std::vector<StationSummary> all;
  if (path_) all.push_back(path_->summary());
  for (const StationView& view : views_) all.push_back(summary_of(view));
  if (has_ranges_ || path_) return all;
  for (StationSummary& station : all) {
    station.step = std::numeric_limits<double>::quiet_NaN();
    if (station.certainty > 0) station.certainty = station.step;
  }
  return all;
}

std::uint64_t StationViews::disk_bytes() const {
  std::uint64_t bytes = path_ ? path_->disk_bytes() : 0;
  for (const StationView& view : views_) bytes += RangeImage::kBytes * (view.left_out ? 2 : 1);
  return bytes;
}

std::unique_ptr<StationViews> watch_stations(const ScanFiles& scan, const OutputConfig& config,
                                             const std::filesystem::path& folder, Ranges ranges) {
  if (config.stations.empty() && !scan.has_scanners()) return nullptr;
  return std::make_unique<StationViews>(scan, config.stations, folder, ranges);
}

}  // namespace lacuna::io
