// SPDX-License-Identifier: Apache-2.0
#include "engine/run/machine.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/terminal.hpp"
#include "tools/run/scan_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
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
  if (!causes.empty()) facts.emplace_back("causes", causes);
  if (summary.surface_area > 0)
    facts.emplace_back("surface", print_surface(summary, detection.opening_area().value_or(0), unit));
  facts.emplace_back("peak memory", print_size(peak_memory()) + " of " + print_size(summary.memory_limit));
  facts.emplace_back("time", print_duration(seconds) + " with " +
                                 counted(summary.threads, "thread", "threads") + ", " +
                                 print_rate(summary.counts.points, seconds));
  return text + print_facts(facts) + "\n";
}

namespace {

std::string later_returns(const AreaCheck& check) {
  return counted(check.later_returns, "later return", "later returns");
}

std::string synthetic_points(const AreaCheck& check) {
  return counted(check.synthetic, "synthetic point", "synthetic points");
}

std::string points_apart(const AreaCheck& check) {
  std::uint64_t points = 0;
  for (const HeightGroup& group : check.apart) points += group.points;
  return counted(points, "point", "points");
}

// Returns "-9,999, and of 1,480 to 1,520".
std::string print_heights(std::span<const HeightGroup> groups) {
  constexpr std::size_t kMost = 3;
  std::string text;
  for (const HeightGroup& group : groups.first(std::min(groups.size(), kMost))) {
    text += text.empty() ? "" : ", and of ";
    text += print_length(group.low, "");
    if (group.high > group.low) text += " to " + print_length(group.high, "");
  }
  if (groups.size() > kMost) text += ", and so on";
  return text;
}

std::string print_kind(VoidKind kind, std::size_t count) {
  return kind == VoidKind::kHole ? counted(count, "hole", "holes")
                                 : print_count(count) + " " + std::string(name_of(kind));
}

std::string print_reason(Undecided reason, const AreaCheck& check, std::string_view unit) {
  switch (reason) {
    case Undecided::kNoPoint:
      return "no point of the scan is in its bounds; are both in the same system?";
    case Undecided::kNoFirstReturn: {
      std::string others;
      if (check.later_returns > 0) others += ", but " + later_returns(check);
      if (check.synthetic > 0) others += ", but " + synthetic_points(check);
      return "no first returns that were measured are in it" + others +
             ", which cover nothing; the files with the first returns are needed, too";
    }
    case Undecided::kSyntheticAlone:
      return "all " + counted(check.points, "point", "points") +
             " in it are flagged as synthetic, and count as if they were measured";
    case Undecided::kOtherSystems:
      return "files of the scan have different coordinate reference systems; --crs states one";
    case Undecided::kFewPoints:
      return "too few points: their spacing is " + print_length(check.spacing, unit) + ", and voids of " +
             print_length(check.void_size, unit) + " need " +
             print_length(AreaCheck::most_spacing(check.void_size), unit) + " or less";
    case Undecided::kHeightsApart:
      return "its voids are covered if " + points_apart(check) + " count, whose heights lie apart";
    case Undecided::kCoarseConversion:
      return "its polygons may lie off by " + print_length(check.area_off, unit) +
             ", more than half of the void size, as they are converted; in the system of the scan they are "
             "exact";
    case Undecided::kSeveralParts:
      return "the scan has " + print_count(check.polygons.size()) +
             (check.polygons.size() > 1 ? " parts" : " large part and many small ones") +
             ", and its outline leaves out " + tools::print_area(check.left_out, unit) +
             " of their convex hull; --area states what is to be covered";
    case Undecided::kBay:
      return "the outline of the scan leaves out a bay that is wider than a void, and in all " +
             tools::print_area(check.left_out, unit) +
             " of its convex hull; --area states what is to be covered";
  }
  return "";
}

}  // namespace

std::string print_answer(const AreaCheck& check, std::string_view unit) {
  const std::size_t counting = check.counting(), excepted = check.voids.size() - counting;
  std::string text(name_of(check.answer()));
  if (!check.undecided.empty()) {
    for (const Undecided reason : check.undecided)
      text.append(reason == check.undecided.front() ? ": " : "; ").append(print_reason(reason, check, unit));
    return text;
  }
  if (counting > 0) {
    std::array<std::size_t, kVoidKinds.size()> kinds{};
    for (std::size_t i = 0; i < counting; ++i) ++kinds[static_cast<std::size_t>(check.voids[i].kind)];
    std::string list;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      if (kinds[i] > 0)
        list.append(list.empty() ? "" : ", ").append(print_kind(static_cast<VoidKind>(i), kinds[i]));
    }
    text += ": " + print_count(counting) + " of " + print_length(check.void_size, unit) + " or more (" +
            list + ")";
  }
  if (excepted > 0)
    text += ", " + (counting > 0 ? print_count(excepted) + " more" : counted(excepted, "void", "voids")) +
            " in exceptions";
  return text;
}

namespace {

std::string print_taking_no_part(const AreaCheck& check) {
  const auto none = [](std::uint64_t count) { return count == 1 ? " takes no part" : " take no part"; };
  std::string text;
  if (check.later_returns > 0) text += "; " + later_returns(check) + none(check.later_returns);
  if (check.synthetic > 0) text += "; " + synthetic_points(check) + none(check.synthetic);
  if (check.repeated > 0 && check.counts_once)
    text += "; " + counted(check.repeated, "point that is there again counts once",
                           "points that are there again count once");
  return text;
}

// "12,300 m², 98.7 % of it covered; 45,600 points", without the share where the answer is not decided.
// Points that take no part follow, if there are any.
std::string print_covered(const AreaCheck& check, std::string_view unit) {
  const double share = check.area > 0 ? 1 - check.missing_area / check.area : 1;
  const std::string covered =
      check.answer() == AreaAnswer::kNotDecided ? "" : ", " + print_share(share) + " of it covered";
  return tools::print_area(check.area, unit) + covered + "; " + counted(check.points, "point", "points") +
         print_taking_no_part(check);
}

// "of the voids that count, 120 m² (34.1 %) lie in buildings"; a line for each class.
std::string print_classes(const AreaCheck& check, std::string_view unit) {
  double voids_area = 0;
  for (std::size_t id = 0; id < check.counting(); ++id) voids_area += check.voids[id].area;
  std::string text;
  for (const AreaClass& each : check.classes) {
    const double share = voids_area > 0 ? each.voids_area / voids_area : 0;
    text += "  of the voids that count, " + tools::print_area(each.voids_area, unit) + " (" +
            print_share(share) + ") lie in " + visible(each.name) + "\n";
  }
  return text;
}

std::string print_basis(const AreaCheck& check) {
  std::size_t width = 0;
  for (const BasisLine& line : check.basis) width = std::max(width, line.thing.size());
  std::string text = "basis\n";
  for (const auto& [thing, what] : check.basis)
    text += "  " + thing + std::string(width - thing.size() + 2, ' ') + visible(what) + "\n";
  text += "this check does not show\n";
  for (const std::string_view each : kNotShown) text.append("  ").append(each).append("\n");
  return text;
}

std::string print_voids(const AreaCheck& check, std::string_view unit) {
  constexpr std::size_t kMostRows = 10;
  if (check.voids.empty()) return "";
  std::vector<std::vector<std::string>> rows = {
      {"largest voids", "kind", "area", "largest circle", "at", "spacing around", "in exceptions"}};
  for (std::size_t id = 0; id < std::min(check.voids.size(), kMostRows); ++id) {
    const Void& each = check.voids[id];
    const std::string place = print_place({each.middle.x(), each.middle.y(), 0}, std::sqrt(check.area));
    rows.push_back(
        {"void " + std::to_string(id), std::string(name_of(each.kind)), tools::print_area(each.area, unit),
         print_length(each.circle, unit), place.substr(0, place.rfind(' ')),
         std::isfinite(each.spacing) ? print_length(each.spacing, unit) : "", print_share(each.excepted)});
  }
  std::string text = print_table(rows);
  if (check.voids.size() > kMostRows)
    text += "  and " + print_count(check.voids.size() - kMostRows) + " more: voids.csv has them all\n";
  return text;
}

}  // namespace

std::string print_check(const AreaCheck& check, std::string_view unit) {
  const std::string voids = print_voids(check, unit);
  return print_answer(check, unit) + "\n\n" + voids + (voids.empty() ? "" : "\n") + "  area  " +
         print_covered(check, unit) + "\n" + print_classes(check, unit) + "\n" + print_basis(check) + "\n";
}

std::vector<std::string> area_warnings(const AreaCheck& check, std::string_view unit) {
  std::vector<std::string> warnings;
  if (!check.apart.empty())
    warnings.push_back(points_apart(check) + " in the bounds of the area at heights of " +
                       print_heights(check.apart) + ", more than " + print_length(check.height_gap, unit) +
                       " off all others, cover nothing, as no-data values and clouds; --bounds with "
                       "heights, min x y z max x y z, says which points count");
  constexpr std::uint64_t kByChance = 20;  // one point in so many has another as near, at most
  if (check.near > check.points / kByChance)
    warnings.push_back("about " + counted(check.near, "point", "points") +
                       " without a time have another within a 25th of the spacing, as copies have that two "
                       "files round differently; such copies count twice in densities and spacings");
  if (!check.counts_once && check.repeated > 0)
    warnings.push_back("about " + print_count(check.repeated) +
                       " points in the area are there twice, as in tiles that overlap, and count twice in "
                       "densities and spacings; with a larger --memory-limit they count once");
  return warnings;
}

}  // namespace lacuna::tools
