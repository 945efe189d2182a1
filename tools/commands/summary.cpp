// SPDX-License-Identifier: Apache-2.0
#include "tools/commands/summary.hpp"

#include "engine/run/disk_space.hpp"
#include "engine/run/machine_memory.hpp"
#include "tools/console/area_text.hpp"
#include "tools/console/measures_text.hpp"
#include "tools/console/terminal.hpp"
#include "tools/console/visible_text.hpp"
#include "tools/run/scan_warnings.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <spdlog/fmt/fmt.h>

namespace lacuna::tools {
using namespace io;

namespace {

std::string print_number(double value) {
  return fmt::format("{:.3g}", value);
}

constexpr std::size_t kMostRows = 10;

std::string print_input(const Counts& counts, const FilteredOut& left_out, const ScanFiles& scan) {
  std::string text = print_count(counts.points) + " points";
  text += scan.files().size() == 1 ? " in " + visible(scan.files().front().name.string())
                                   : " in " + std::to_string(scan.files().size()) + " files, as one scan";
  text += print_left_out(counts, left_out);
  if (counts.thinned_out > 0) text += "; " + print_count(counts.thinned_out) + " thinned out";
  if (counts.duplicates > 0) text += "; " + counted(counts.duplicates, "duplicate", "duplicates");
  return text;
}

double extent_of(const Summary& summary) {
  const Eigen::AlignedBox3d& bounds = summary.strays.rest;
  return bounds.isEmpty() ? 0 : bounds.sizes().maxCoeff();
}

// Returns the loops of one kind by area, the largest first.
std::vector<std::size_t> loops_of(const std::vector<LoopMeasures>& loops, LoopKind kind) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (loops[i].kind == kind) found.push_back(i);
  }
  std::stable_sort(found.begin(), found.end(),
                   [&](std::size_t a, std::size_t b) { return loops[a].area > loops[b].area; });
  return found;
}

std::string print_largest(const std::vector<LoopMeasures>& loops, const std::vector<std::size_t>& holes,
                          double extent, std::string_view unit) {
  if (holes.empty()) return "";
  std::vector<std::vector<std::string>> rows = {
      {"largest holes", "area", "perimeter", "diameter", "centre", "points", "confidence"}};
  for (std::size_t at = 0; at < std::min(holes.size(), kMostRows); ++at) {
    const LoopMeasures& loop = loops[holes[at]];
    rows.push_back({"loop " + std::to_string(holes[at]), print_area(loop.area, unit),
                    print_length(loop.perimeter, unit), print_length(loop.diameter, unit),
                    print_place(loop.centroid, extent), print_count(loop.points),
                    fmt::format("{:.3f}", loop.track.confidence)});
  }
  std::string text = "\n" + print_table(rows);
  if (holes.size() > kMostRows) {
    text += "  and " + counted(holes.size() - kMostRows, "more hole", "more holes") +
            ": holes.csv has them all\n";
  }
  return text;
}

// Prints one line for each label, values below one another.
std::string print_facts(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::size_t width = 0;
  for (const auto& [label, value] : facts) width = std::max(width, label.size());
  std::string text;
  for (const auto& [label, value] : facts) {
    text += "  " + label + std::string(width - label.size() + 2, ' ') + value + "\n";
  }
  return text;
}

// Returns an empty text if no station is known.
std::string print_causes(const ExplainedDetection& detection) {
  std::array<std::size_t, kCauses + 1> counts{};  // the last one: without a cause
  for (std::size_t i = 0; i < detection.causes.size(); ++i) {
    if (detection.loops[i].kind != LoopKind::kHole) continue;
    const auto cause = detection.causes[i].main();
    ++counts[cause ? static_cast<std::size_t>(*cause) : kCauses];
  }
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    std::string name(i < kCauses ? kCauseNames[i] : "not known");
    std::replace(name.begin(), name.end(), '_', ' ');
    text += (text.empty() ? "" : ", ") + print_count(counts[i]) + " " + name;
  }
  return text;
}

// Openings are no missing surface. They are 0 where causes are not known.
std::string print_surface(const Summary& summary, double openings, std::string_view unit) {
  const double area = summary.surface_area, missing = summary.hole_area - openings;
  std::string text = "about " + print_area(area, unit) + " sampled";
  if (summary.hole_area > 0)
    text += ", " + print_area(missing, unit) + " missing: " + print_number(100 * missing / (area + missing)) +
            " % of both";
  if (openings > 0) text += "; " + print_area(openings, unit) + " openings";
  return text + (unit.empty() ? " (areas; unit not stated)" : "");
}

std::vector<std::pair<std::string, std::string>> findings(const ExplainedDetection& detection,
                                                          const ScanFiles& scan, std::string_view unit) {
  const Summary& summary = detection.summary;
  const Counts& counts = summary.counts;
  std::vector<std::pair<std::string, std::string>> facts = {
      {"input", print_input(counts, detection.counts.filtered_out, scan)}};
  if (!scan.common_crs().empty()) facts.emplace_back("crs", crs_name(scan.common_crs()));
  if (summary.resolution > 0) {
    const std::uint64_t representatives = counts.points - counts.dropped - counts.thinned_out;
    facts.emplace_back("first level", print_length(summary.resolution, unit) + ": " +
                                          print_count(representatives) + " points are used, one per cell");
  }
  facts.emplace_back("neighbours", print_number(summary.mean_neighbours) + " of a point on average, " +
                                       print_length(summary.median_distance, unit) + " away (median)");
  if (counts.undefined_normals > 0)
    facts.emplace_back("normals", "none at " + counted(counts.undefined_normals, "point", "points"));
  if (counts.normals_off > 0) {
    facts.emplace_back("given normals", counted(counts.normals_off, "is", "are") +
                                            " off by more than 45 degrees from the estimated one");
  }
  facts.emplace_back("boundary", counted(counts.boundary_points, "point", "points"));
  if (summary.e > 0) {  // the method of the paper
    facts.emplace_back("graph", counted(counts.boundary_edges, "eligible edge", "eligible edges") + ", " +
                                    counted(counts.components, "component", "components") +
                                    "; loops of more than " + std::to_string(summary.e) + " edges");
  }
  facts.emplace_back("tiles", print_count(summary.tiles) + ", of at most " +
                                  counted(summary.tile_points, "point", "points"));
  return facts;
}

}  // namespace

std::string print_left_out(const Counts& counts, const FilteredOut& filtered) {
  std::string text;
  const auto add = [&text](std::uint64_t points, const char* why) {
    if (points > 0) text += "; " + print_count(points) + " " + why;
  };
  add(counts.dropped - filtered.total(), "not finite, dropped");
  for (const FilterCount& filter : kFilterCounts) add(filtered.*filter.count, filter.points);
  add(filtered.synthetic, "flagged as synthetic, which were not measured");
  return text;
}

std::string print_summary(const ExplainedDetection& detection, const ScanFiles& scan, double seconds) {
  const std::string& unit = scan.length_unit();
  const Summary& summary = detection.summary;
  const std::vector<LoopMeasures>& loops = detection.loops;
  const double extent = extent_of(summary);
  const std::vector<std::size_t> holes = loops_of(loops, LoopKind::kHole);
  const std::size_t outer = loops.size() - holes.size();
  const std::string causes = print_causes(detection);

  std::string text = counted(holes.size(), "hole", "holes") + ", " +
                     counted(outer, "outer curve", "outer curves") + "\n" +
                     print_largest(loops, holes, extent, unit) + "\n";
  auto facts = findings(detection, scan, unit);
  if (detection.area) {
    facts.emplace_back("area", print_answer(*detection.area, unit));
    facts.emplace_back("", print_covered(*detection.area, unit));
  }
  if (!causes.empty()) facts.emplace_back("causes", causes);
  if (summary.surface_area > 0)
    facts.emplace_back("surface", print_surface(summary, detection.opening_area().value_or(0), unit));
  facts.emplace_back("peak memory", print_size(peak_memory()) + " of " + print_size(summary.memory_limit));
  facts.emplace_back("time", print_duration(seconds) + " with " +
                                 counted(summary.threads, "thread", "threads") + ", " +
                                 print_rate(summary.counts.points, seconds));
  return text + print_facts(facts) + "\n";
}

}  // namespace lacuna::tools
