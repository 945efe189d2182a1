// SPDX-License-Identifier: Apache-2.0
#include "tools/console/area_text.hpp"

#include "tools/console/measures_text.hpp"
#include "tools/console/visible_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lacuna::tools {
using namespace io;

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

}  // namespace

std::string print_covered(const AreaCheck& check, std::string_view unit) {
  const double share = check.area > 0 ? 1 - check.missing_area / check.area : 1;
  const std::string covered =
      check.answer() == AreaAnswer::kNotDecided ? "" : ", " + print_share(share) + " of it covered";
  return tools::print_area(check.area, unit) + covered + "; " + counted(check.points, "point", "points") +
         print_taking_no_part(check);
}

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

}  // namespace lacuna::tools
