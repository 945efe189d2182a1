// SPDX-License-Identifier: Apache-2.0
#include "tools/run/scan_warnings.hpp"

#include "engine/run/error.hpp"
#include "engine/run/machine.hpp"
#include "engine/summarise.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/explain/stations/station_views.hpp"
#include "io/read/crs/crs.hpp"
#include "io/read/files/number.hpp"
#include "io/read/scan/scan_files.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include <spdlog/fmt/fmt.h>

namespace lacuna::tools {
using namespace io;

namespace {

constexpr const char* kDegrees = " is in longitude and latitude, and holes need lengths";

// Prints a coordinate in whole steps, a power of ten.
std::string print_in_steps(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(std::lround(-std::log10(step))));
  return fmt::format("{:.{}f}", value * step + 0.0, decimals);
}

std::string file_name(const ScanFiles& scan, std::size_t i) {
  return visible(scan.files()[i].name.string());
}

std::string more_files(std::size_t count) {
  if (count == 0) return "";
  return ", and " + print_count(count) + (count == 1 ? " more file" : " more files");
}

// A warning of files: `when` it comes, and its `words` about the first file that it holds for. The others are
// counted, or have lines of their own.
struct FileRule {
  std::function<bool(const ScanFile&)> when;
  std::function<std::string(const ScanFile&)> words;
  bool has_line_for_each = false;
};

void warn_of_files(const ScanFiles& scan, std::vector<std::string>& warnings, const FileRule& rule) {
  auto first = std::ranges::find_if(scan.files(), rule.when);
  for (; first != scan.files().end(); first = std::find_if(first + 1, scan.files().end(), rule.when)) {
    const auto others = std::count_if(first + 1, scan.files().end(), rule.when);
    const std::size_t more = rule.has_line_for_each ? 0 : static_cast<std::size_t>(others);
    warnings.push_back(visible(first->name.string()) + more_files(more) + ": " + rule.words(*first));
    if (!rule.has_line_for_each) return;
  }
}

// One warning has the notes of all files that are alike. `notes_of_file` returns those of file i.
template <class NotesOfFile>
void warn_of_notes(const ScanFiles& scan, std::vector<std::string>& warnings,
                   const NotesOfFile& notes_of_file) {
  struct Alike {
    std::size_t first, others = 0;  // files
    std::uint64_t count = 0;
  };
  std::map<std::pair<std::string, std::string>, Alike> notes;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    for (const ReaderNote& note : notes_of_file(i)) {
      if (note.count == 0) continue;
      const auto [at, is_new] = notes.try_emplace({note.thing, note.what}, Alike{.first = i});
      at->second.others += is_new ? 0 : 1;
      at->second.count += note.count;
    }
  }
  for (const auto& [note, alike] : notes)
    warnings.push_back(file_name(scan, alike.first) + more_files(alike.others) + ": " +
                       print_count(alike.count) + " " + note.first + (alike.count == 1 ? "" : "s") +
                       note.second);
}

// Warns of files that lie on each other where each has its scanner at 0 0 0, and its viewpoint elsewhere.
void warn_of_own_axes(const ScanFiles& scan, const ScanCounts& counts, std::vector<std::string>& warnings) {
  const std::vector<ScanFile>& files = scan.files();
  const auto is_moved = [](const ScanFile& file) { return file.scanner.has_value(); };
  const auto first = std::ranges::find_if(files, is_moved);
  if (first == files.end()) return;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (is_moved(files[i]) && 2 * counts.files[i].nearer_to_zero < 3 * counts.files[i].nearer_to_scanner)
      return;
  }
  const auto is_elsewhere = [&](const ScanFile& file) {
    const bool has_place = is_moved(file) || file.has_scanner_at_zero;
    return has_place && file.scanner.value_or(Eigen::Vector3d::Zero()) != *first->scanner;
  };
  if (std::ranges::none_of(files, is_elsewhere)) return;
  const std::string text =
      "points lie around 0 0 0, and not around the viewpoint " + print_point(*first->scanner) +
      "; if they are in the axes of their scanner, `FILE pose=viewpoint` in a list moves each PCD to its "
      "place, and `pose=` with numbers any file";
  warn_of_files(scan, warnings, {is_moved, [&](const ScanFile&) { return text; }});
}

// What the user states of all files: files that contradict it.
FileRule overridden(std::string ScanFile::*text, const std::function<bool(const std::string&)>& is_same,
                    const std::string& what, const std::string& stated) {
  return {[=](const ScanFile& file) { return !(file.*text).empty() && !is_same(file.*text); },
          [=](const ScanFile& first) {
            return "its " + what + " is " + crs_name(first.*text) + "; the stated one holds, " +
                   crs_name(stated);
          }};
}

// Where the user states no system: what the files say of theirs, in the order of its lines.
std::vector<FileRule> rules_of_systems(const ScanFiles& scan) {
  const auto has_crs = [](const ScanFile& file) { return !file.crs.empty(); };
  const auto first = std::ranges::find_if(scan.files(), has_crs);
  if (first == scan.files().end()) return {};
  return {
      {.when = [](const ScanFile& file) { return !file.other_crs.empty(); },
       .words =
           [](const ScanFile& file) {
             const std::string holds = crs_name(file.crs);
             return "its records name two coordinate reference systems, " + holds + " and " +
                    crs_name(file.other_crs) + "; " + holds +
                    " holds, by a bit of the header (global encoding); --crs states another";
           }},
      {.when = [=](const ScanFile& file) { return has_crs(file) && !is_same_crs(file.crs, first->crs); },
       .words =
           [=](const ScanFile& file) {
             return "its coordinate reference system differs from the first file: " + crs_name(file.crs) +
                    ", not " + crs_name(first->crs) + "; results name none, unless --crs states it";
           },
       .has_line_for_each = true},
      // A file with a pose is in the system of the others, not in its own.
      {.when =
           [&](const ScanFile& file) { return !scan.common_crs().empty() && !has_crs(file) && !file.pose; },
       .words =
           [&](const ScanFile&) {
             return "without a coordinate reference system; the system of the other files holds, " +
                    crs_name(scan.common_crs());
           }}};
}

// Where the user states no unit: files whose unit is another than that of the first one with a unit, and
// files that contradict themselves.
std::vector<FileRule> rules_of_units(const ScanFiles& scan) {
  const auto has_unit = [](const ScanFile& file) { return !file.unit.empty(); };
  const auto first = std::ranges::find_if(scan.files(), has_unit);
  const bool are_same = first == scan.files().end() || !scan.length_unit().empty();
  return {
      {.when = [=](const ScanFile& file) { return !are_same && has_unit(file) && file.unit != first->unit; },
       .words =
           [=](const ScanFile& other) {
             return "its unit is " + other.unit + ", not " + first->unit + " as in " +
                    visible(first->name.string()) + "; results name none, unless --unit states it";
           }},
      {.when =
           [](const ScanFile& file) {
             return !file.crs.empty() && file.unit.empty() && facts_of(file.crs).known_text.empty();
           },
       .words =
           [](const ScanFile& file) {
             return crs_name(file.crs) + ": its unit is not known, as " +
                    (find_gis_function(kLookUpCrs) == nullptr ? "lacuna_gis.so is missing"
                                                              : "GDAL does not understand its system") +
                    "; --unit states it";
           }},
      {.when = [](const ScanFile& file) { return !file.contradiction.empty(); },
       .words = [](const ScanFile& file) { return crs_name(file.crs) + ": " + file.contradiction; }}};
}

std::vector<FileRule> rules_before_a_run(const ScanFiles& scan) {
  const std::string &crs = scan.stated_crs().crs, &unit = scan.stated_crs().unit;
  std::vector<FileRule> rules;
  if (crs.empty()) {
    rules = rules_of_systems(scan);
  } else {
    rules.push_back(overridden(
        &ScanFile::crs, [&](const std::string& other) { return is_same_crs(other, crs); },
        "coordinate reference system", crs));
  }
  if (crs.empty() && unit.empty())
    rules.push_back({std::mem_fn(&ScanFile::may_be_degrees), [](const ScanFile&) {
                       return "x and y look like longitude and latitude in degrees, and holes need lengths; "
                              "project them first, as with `gdaltransform`; if they are lengths, --unit m or "
                              "another unit says so";
                     }});
  if (unit.empty()) {
    std::ranges::move(rules_of_units(scan), std::back_inserter(rules));
  } else {
    rules.push_back(overridden(
        &ScanFile::unit, [&](const std::string& other) { return other == unit; }, "unit", unit));
  }
  rules.push_back({[](const ScanFile& file) { return file.z_factor != 1; },
                   [](const ScanFile& first) {
                     return "z is in " + first.z_unit +
                            ", and is brought into the unit of x and y; --unit-z states another unit; the "
                            "annotated scan keeps its own z";
                   }});
  return rules;
}

// Throws `Error` if lengths in the system are not those on the ground, where a file lies.
void refuse_other_scale(const ScanFiles& scan, std::size_t file, const std::string& name,
                        const std::string& crs) {
  constexpr double kMost = 0.01;
  const auto place = find_place(scan, file);
  const auto scale = place ? scale_at(crs, *place) : std::nullopt;
  if (!scale) return;
  const double x = scale->scale_x, y = scale->scale_y;
  if (std::max(std::abs(x - 1), std::abs(y - 1)) <= kMost) return;
  throw Error(fmt::format(
      "{}: {} has lengths {:.3g} times{} those on the ground at latitude {:.3g}; `pdal translate IN OUT "
      "reprojection --filters.reprojection.out_srs={}` brings them to scale; if its coordinates are true "
      "lengths, --crs can state their system",
      name, crs_name(crs), x, std::abs(x / y - 1) > kMost ? fmt::format(" (along y {:.3g} times)", y) : "",
      scale->latitude, utm_zone(scale->longitude, scale->latitude)));
}

[[noreturn]] void refuse_longitudes(const ScanFiles& scan, std::size_t file) {
  const std::string name = scan.files()[file].crs.empty() ? "its system" : crs_name(scan.files()[file].crs);
  const auto place = find_place(scan, file);
  if (place && place->head<2>().cwiseAbs().maxCoeff() > 360)
    throw Error(fmt::format(
        "{}: {} is in longitude and latitude, but its coordinates are far beyond degrees, such as {:.10g} "
        "{:.10g}; --crs states the system that they are in, such as EPSG:25832",
        file_name(scan, file), name, place->x(), place->y()));
  throw Error(file_name(scan, file) + ": " + name + kDegrees +
              "; `pdal translate IN OUT reprojection --filters.reprojection.out_srs=EPSG:N` projects it; if "
              "its coordinates are lengths, --crs can state their system");
}

}  // namespace

std::string crs_name(const std::string& crs) {
  return visible(name_of_crs(crs));
}

void require_lengths(const ScanFiles& scan) {
  const std::string& stated = scan.stated_crs().crs;
  if (facts_of(stated).is_geographic)
    throw Error("--crs: " + crs_name(stated) + kDegrees + "; allowed: a projected or geocentric system");
  if (!stated.empty()) return refuse_other_scale(scan, 0, "--crs", stated);
  const std::string* checked = nullptr;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    const std::string& crs = scan.files()[i].crs;
    // Names of columns say so, but the user may know better.
    if (scan.files()[i].is_geographic && crs.empty() && !scan.stated_crs().unit.empty()) continue;
    if (scan.files()[i].is_geographic && crs.empty())
      throw Error(
          file_name(scan, i) +
          ": x and y are longitude and latitude in degrees, by their names, and holes need lengths; project "
          "them first, as with `gdaltransform`; if they are lengths, --unit m or another unit says so");
    if (scan.files()[i].is_geographic) refuse_longitudes(scan, i);
    if (crs.empty() || (checked != nullptr && crs == *checked)) continue;
    refuse_other_scale(scan, i, file_name(scan, i), crs);
    checked = &crs;
  }
}

std::vector<std::string> input_warnings(const ScanFiles& scan) {
  std::vector<std::string> warnings;
  for (const std::size_t i : repeated_files(scan))
    warnings.push_back(file_name(scan, i) + ": given more than once; its points are the same");
  warn_of_notes(scan, warnings, [&](std::size_t i) { return scan.files()[i].notes; });
  for (const FileRule& rule : rules_before_a_run(scan)) warn_of_files(scan, warnings, rule);
  return warnings;
}

std::vector<std::string> memory_warnings(const Config& config) {
  const std::uint64_t memory = machine_memory();
  if (config.run.memory_limit <= memory) return {};
  return {"the memory limit of " + print_size(config.run.memory_limit) + " is above the " +
          print_size(memory) + " of this machine"};
}

std::string print_bounds(const Eigen::AlignedBox3d& box, double margin) {
  constexpr int kDigits = 3;
  const double extent = box.sizes().maxCoeff() + 2 * margin;
  const double step = extent > 0 ? std::pow(10, std::floor(std::log10(extent)) + 1 - kDigits) : 1;
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
    text += print_in_steps(std::floor((box.min()[axis] - margin) / step), step) + ",";
  for (int axis = 0; axis < 3; ++axis)
    text += print_in_steps(std::ceil((box.max()[axis] + margin) / step), step) + (axis < 2 ? "," : "");
  return text;
}

std::string stray_warning(const Strays& strays, double resolution) {
  if (strays.points == 0) return "";
  const bool is_one = strays.points == 1;
  std::string text = counted(strays.points, "point lies", "points lie") + " far from all others, " +
                     (is_one ? "at " : "such as at ") + print_point(strays.example) +
                     "; reports and pictures leave " + (is_one ? "it" : "them") + " out. ";
  if (strays.has_origin) text += "--drop-origin drops points at 0 0 0";
  if (strays.has_origin && !is_one) text += "; ";
  if (!strays.has_origin || !is_one)
    text += "--bounds=" + print_bounds(strays.rest, resolution) + " keeps the others alone";
  return text;
}

std::string normals_warning(const Counts& counts, NormalsUse use) {
  constexpr std::uint64_t kFew = 100;
  if (counts.normals_off == 0 || kFew * counts.normals_off < counts.points) return "";
  return print_count(counts.normals_off) +
         " normals of the scan are off by more than 45 degrees from the surface" +
         (use == NormalsUse::kGiven
              ? ", so that holes can be missed; --normals estimated leaves them out"
              : "; these are estimated from the points instead; --normals given uses those of the scan");
}

std::vector<std::string> filter_warnings(const ScanFiles& scan, const ScanCounts& counts,
                                         const Eigen::AlignedBox3d& bounds) {
  constexpr double kMostNoise = 0.03;
  std::vector<std::string> warnings;
  warn_of_notes(scan, warnings, [&](std::size_t i) { return notes_of(counts.files[i].findings); });
  warn_of_own_axes(scan, counts, warnings);
  std::uint64_t points = 0;
  for (const std::uint64_t rows : rows_of(scan, counts)) points += rows;
  const FilteredOut& left_out = counts.filtered_out;
  const double share =
      static_cast<double>(left_out.noise) / static_cast<double>(std::max<std::uint64_t>(points, 1));
  if (share > kMostNoise)
    warnings.push_back(print_count(left_out.noise) + " points, " + std::to_string(std::lround(100 * share)) +
                       " %, are left out as noise, of the classes 7 and 18; --keep-noise keeps them");
  if (!scan.config().drop_origin || left_out.origin > 0 || bounds.isEmpty()) return warnings;
  if (bounds.exteriorDistance(Eigen::Vector3d::Zero().eval()) <= bounds.diagonal().norm()) return warnings;
  warn_of_files(scan, warnings,
                {std::mem_fn(&ScanFile::has_scanner_at_zero), [](const ScanFile&) {
                   return "the place of the scanner is 0 0 0, far from the points, and --drop-origin dropped "
                          "none; rays "
                          "without return may be at the true place, where --leave-out drops a box";
                 }});
  return warnings;
}

namespace {

void warn_of_own_frames(const ScanFiles& scan, const ExplainedDetection& detection,
                        std::vector<std::string>& warnings) {
  const auto has_pose = [](const ScanFile& file) { return file.pose.has_value(); };
  if (scan.has_scanners() || std::ranges::any_of(scan.files(), has_pose)) return;
  std::vector<std::uint64_t> ends;
  for (const std::uint64_t rows : rows_of(scan, detection.counts))
    ends.push_back((ends.empty() ? 0 : ends.back()) + rows);
  if (const auto own = own_frames(detection, ends))
    warnings.push_back(
        file_name(scan, own->first) + " and " + file_name(scan, own->second) +
        " do not fit: each seems to be in the axes of its own scanner, at 0 0 0; a list of files "
        "states poses, as `scan.ply pose=scan.xf`");
}

}  // namespace

std::string small_loops_warning(const std::vector<LoopMeasures>& loops) {
  constexpr double kWanted = 10;    // diameter of a hole that stands out, in spacings
  constexpr std::size_t kFew = 20;  // loops
  std::vector<double> spacings;     // of small loops
  for (const LoopMeasures& loop : loops) {
    const LoopEvidence& evidence = loop.track.evidence;
    if (evidence.is_small()) spacings.push_back(evidence.spacing);
  }
  if (spacings.size() < kFew || 2 * spacings.size() <= loops.size()) return "";
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  const double rounded = std::stod(fmt::format("{:.0e}", kWanted * *middle));
  return fmt::format(
      "{} of {} loops are less than {:g} spacings wide, hardly more than the gaps between points; --min-hole "
      "{:g} leaves most of them out",
      spacings.size(), loops.size(), LoopEvidence::kSmallWidth, rounded);
}

std::string nothing_warning(const Detection& detection, const SelectionConfig& selection) {
  constexpr std::uint64_t kMany = 1000;
  const Summary& summary = detection.summary;
  const std::uint64_t points = summary.levels.empty() ? 0 : summary.levels.front().points;
  const bool is_left_out = summary.counts.raw_loops > 0 && !(selection == SelectionConfig());
  if (!detection.loops.empty() || points < kMany || is_left_out) return "";
  const std::string found =
      "neither a hole nor an outer curve among " + print_count(points) + " points; they ";
  switch (shape_of(summary)) {
    case ScanShape::kTooFewNeighbours:
      return fmt::format(
          "{}have {:.2g} neighbours on average, which are too few to show a surface; --k states more", found,
          summary.mean_neighbours);
    case ScanShape::kLines:
      return found + "lie on lines, as of a wire or a single profile, and holes need a surface";
    case ScanShape::kSurface:
      return found +
             "lie on a thin surface, so it is probably closed, as a sphere is; if it is open, a filter may "
             "have moved its points, and the scan before the filter shows its holes";
    case ScanShape::kNoSurface:
      break;
  }
  return found +
         "do not lie on one thin surface, as after noise, or a voxel filter that moves points into layers; "
         "the scan before the filter shows its holes (--resolution thins without moving), unless it is "
         "closed";
}

std::vector<std::string> scan_warnings(const ScanFiles& scan, const ExplainedDetection& detection,
                                       const FilesConfig& config) {
  const Summary& summary = detection.summary;
  std::vector<std::string> warnings = filter_warnings(scan, detection.counts, summary.strays.rest);
  const auto add = [&](std::string line) {
    if (!line.empty()) warnings.push_back(std::move(line));
  };
  add(nothing_warning(detection, with_min_hole(config).selection));
  add(small_loops_warning(detection.loops));
  add(stray_warning(summary.strays, summary.resolution));
  add(normals_warning(summary.counts, config.normals.use));
  const Counts& counts = summary.counts;
  const std::uint64_t points = counts.points - counts.dropped - counts.thinned_out - counts.duplicates;
  if (points <= static_cast<std::uint64_t>(config.neighbourhood.k)) {
    warnings.push_back(print_count(points) + " distinct " + (points == 1 ? "point" : "points") +
                       "; each needs k = " + std::to_string(config.neighbourhood.k) + " neighbours");
  }
  const bool thins = counts.thinned_out > counts.points / 100;
  if (config.scale.min_hole > 0 && summary.resolution > 0 && !thins && points > 0) {
    warnings.push_back(fmt::format(
        "--min-hole {:g} thins nothing: neighbours are {:g}{} apart; it is a length in the unit of the scan",
        config.scale.min_hole, summary.median_distance,
        scan.length_unit().empty() ? "" : " " + scan.length_unit()));
  }
  add(steps_warning(detection, has_single_precision(scan)));
  warn_of_own_frames(scan, detection, warnings);
  return warnings;
}

namespace {

// Returns the width of a station's view.
double degrees_of(const StationSummary& station) {
  return std::max(2 * 180 / std::numbers::pi * station.spread, 0.01);
}

// A path whose rows are not all of it, or whose times are coarse. A station with rays of one range, and one
// that is far off, though the scan itself states it.
void warn_of_path(const StationSummary& station, std::vector<std::string>& warnings) {
  constexpr std::uint64_t kFewRays = 100;
  constexpr double kFarOff = 0.01;  // radians; no scanner has so narrow a view
  const std::uint64_t rows = station.left_out.rows;
  if (rows > 0)
    warnings.push_back(
        fmt::format("trajectory {}: {} left out, at time {:.12g}{}: a hundred times the speed "
                    "of the others leads there",
                    visible(station.name), counted(rows, "row is", "rows are"), station.left_out.time,
                    rows == 1 ? "" : " and later"));
  if (station.coarse_step > 0 && std::isfinite(station.coarse_step))
    warnings.push_back(
        fmt::format("trajectory {}: times of points are in steps of {:.2g}, and its scanner moves on in one; "
                    "causes of holes are less sure; times with more digits, as in 64 bits, help",
                    visible(station.name), station.coarse_step));
  if (const double range = station.one_range; range > 0)
    warnings.push_back(
        fmt::format("station {}: many rays end {:.3g} from it, as some scanners write rays without return; ",
                    visible(station.name), range) +
        (range > 0.99 * station.farthest
             ? "--bounds leaves them out"
             : "they hide what is behind; --leave-out=" +
                   print_bounds({station.place, station.place}, 1.01 * range) + " drops a box around it"));
  const bool is_refused = station.certainty < StationView::kLeastCertain;
  if (station.path > 0 || station.points < kFewRays || is_refused || !(station.spread < kFarOff)) return;
  warnings.push_back(fmt::format(
      "station {}, at {}, has most of its points within {:.2g} degrees of one direction, as from a place far "
      "off; causes of holes depend on it; points may have been at their place before a pose moved them, or "
      "--stations states the true place",
      visible(station.name), print_point(station.place), degrees_of(station)));
}

}  // namespace

std::string upward_warning(const Upward& upward) {
  // Quaternions that turn the axis, or its opposite, to z.
  constexpr std::array<std::array<const char*, 2>, 3> kTurns = {{{"0 -0.7071 0 0.7071", "0 0.7071 0 0.7071"},
                                                                 {"0.7071 0 0 0.7071", "-0.7071 0 0 0.7071"},
                                                                 {"", "1 0 0 0"}}};
  const auto axis = static_cast<std::size_t>(upward.axis);
  const std::string name(1, "xyz"[axis]), opposite = "-" + name;
  std::string counts;
  for (const std::uint64_t points : upward.level)
    counts += (counts.empty() ? "" : ", ") + print_count(points);
  return (upward.is_down    ? opposite
          : upward.is_known ? name
                            : name + " or " + opposite) +
         " seems to be up, not z, by the level surfaces (points level along x, y, z: " + counts +
         "); floors are found by z, and so are causes and places of scanners; `SCAN pose=0 0 0 " +
         kTurns[axis][upward.is_down ? 1 : 0] +
         "` in a list of files turns the scan, and its stations need the same";
}

std::vector<std::string> station_warnings(const std::vector<StationSummary>& stations,
                                          const PointsOfNone& of_none, const std::optional<Upward>& upward) {
  std::vector<std::string> warnings;
  for (const StationSummary& station : stations) {
    warn_of_path(station, warnings);
    if (station.points == 0)
      warnings.push_back("station " + visible(station.name) + " does not count: the scan has no points of " +
                         visible(station.subject));
    if (station.points == 0 || !(station.certainty < StationView::kLeastCertain)) continue;
    const bool moved = station.path > 0;
    std::string line = (moved ? "trajectory " : "station ") + visible(station.name) + " does not count: ";
    const double timed =
        static_cast<double>(station.points) / static_cast<double>(station.points + station.untimed);
    if (station.certainty > 0 && timed < StationView::kLeastCertain) {
      line += fmt::format(
          "{:.3g} % of the points have no time of the path; it must cover their times without gaps, in their "
          "clock",
          100 * (1 - timed));
    } else if (std::isinf(station.coarse_step)) {
      line += "all of its points have one time, and its scanner moves";
    } else {
      if (station.certainty > 0)
        line += fmt::format(
            "at most {:.3g} % of its points can have been seen from there{}, as rays end at the "
            "first surface",
            100 * station.certainty, moved ? " at their times" : "");
      else
        line += fmt::format(
            "most of its points lie within {:.2g} degrees of one direction, as from a place "
            "far off the scan",
            degrees_of(station));
      line += "; its coordinates must have the unit and the system of the scan";
      if (moved) line += ", and its times their clock";
    }
    warnings.push_back(std::move(line));
  }
  if (of_none.points > 0)
    warnings.push_back(print_count(of_none.points) + (of_none.points == 1 ? " point has" : " points have") +
                       " no station, such as those of " + visible(of_none.subject) +
                       "; causes of holes leave out what their scanner saw");
  if (upward) warnings.push_back(upward_warning(*upward));
  return warnings;
}

}  // namespace lacuna::tools
