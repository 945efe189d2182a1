// SPDX-License-Identifier: Apache-2.0

#include "engine/run/error.hpp"
#include "io/read/crs/crs_text.hpp"
#include "io/write/report/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <spdlog/fmt/fmt.h>

namespace lacuna::io {
namespace {

constexpr std::size_t kMostVoids = 500, kMostOthers = 2000, kMostPolygons = 10'000;
constexpr double kStepsOfMap = 800;  // a map shows nothing finer than this part of its extent

using Event = Json::parse_event_t;

// A ring as fine as a map shows it. No corner is nearer than `step` to the one before, and there are at most
// some thousand.
class CoarseRing {
 public:
  explicit CoarseRing(double step) : step_(step) {}

  void begin() {
    corners_.clear();
    stride_ = 1;
    passed_ = 0;
  }
  void add(const Eigen::Vector2d& corner) {
    if (!corners_.empty() && (corner - last_).norm() < step_) return;
    last_ = corner;
    if (passed_++ % stride_ == 0) corners_.push_back(corner);
    if (corners_.size() < 2 * kMost) return;
    for (std::size_t i = 0; i < kMost; ++i) corners_[i] = corners_[2 * i];
    corners_.resize(kMost);
    stride_ *= 2;
  }
  Json json() const {
    Json ring = Json::array();
    for (const Eigen::Vector2d& corner : corners_) ring.push_back({corner.x(), corner.y()});
    return ring;
  }

 private:
  static constexpr std::size_t kMost = 4096;

  double step_;
  std::vector<Eigen::Vector2d> corners_;
  Eigen::Vector2d last_{0, 0};
  std::size_t stride_ = 1, passed_ = 0;
};

// The lists of voids.json. A large outline is never held: its corners pass one by one.
class Lists {
 public:
  explicit Lists(double step) : ring_(step) {}

  bool keep(int depth, Event event, Json& parsed) {
    const bool is_end = event == Event::array_end;
    if (depth == kList && event == Event::key) name_ = parsed.get<std::string>();
    if (depth == kElement && event == Event::object_end) return take(parsed);
    if (depth == kRing && event == Event::array_start) ring_.begin();
    if (depth == kCorner && is_end)
      return take_corner({parsed.at(0).get<double>(), parsed.at(1).get<double>()});
    if (depth == kRing && is_end) parsed = ring_.json();
    return depth != kRing || !is_end || parsed.size() >= 3;
  }

  const Eigen::AlignedBox2d& polygons() const { return polygons_; }  // the box around them
  void put_into(Json& area) {
    area["all"] = voids_;
    for (auto& [name, list] : lists_) area.at(name) = std::move(list);
  }

 private:
  enum Depth { kList = 1, kElement, kOutline, kRing, kCorner };

  // Elements go into lists of their own. To remove one from a list of the parser takes as long as the list.
  bool take(Json& element) {
    Json& list = lists_.try_emplace(name_, Json::array()).first->second;
    voids_ += name_ == "voids";
    const std::size_t most = name_ == "voids"      ? kMostVoids
                             : name_ == "polygons" ? kMostPolygons
                                                   : kMostOthers;
    if (list.size() < most) list.push_back(std::move(element));
    return false;
  }

  bool take_corner(const Eigen::Vector2d& corner) {
    if (name_ == "polygons") polygons_.extend(corner);
    ring_.add(corner);
    return false;
  }

  CoarseRing ring_;
  std::string name_;  // of the list
  std::size_t voids_ = 0;
  Eigen::AlignedBox2d polygons_;
  std::map<std::string, Json> lists_;
};

}  // namespace

Json read_area_section(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kVoidsFile;
  if (!std::filesystem::exists(file)) return nullptr;
  try {
    Json area;
    const auto read = [&](double step) {
      Lists lists(step);
      area = read_json(file, kResultOfDetect, [&](int depth, Event event, Json& parsed) {
        return lists.keep(depth, event, parsed);
      });
      return lists;
    };
    const Eigen::AlignedBox2d box = read(HUGE_VAL).polygons();
    Lists lists = read(box.isEmpty() ? 0 : box.sizes().maxCoeff() / kStepsOfMap);
    if (area.at("schema") != kVoidsSchema)
      throw Error(file.string() + ": its schema is " + print(area.at("schema"), -1) + "; \"" +
                  std::string(kVoidsSchema) + "\" is read");
    lists.put_into(area);
    return area;
  } catch (const Json::exception& error) {
    throw Error(file.string() + ": is not as lacuna writes it: " + error.what());
  }
}

namespace {

constexpr std::size_t kMostRows = 8, kMostOnMap = 500;

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    if (c == '<')
      html += "&lt;";
    else if (c == '&')
      html += "&amp;";
    else if (c == '"')
      html += "&quot;";
    else
      html += c;
  }
  return html;
}

std::string fixed(double value, int decimals) {
  return fmt::format("{:.{}f}", value, decimals);
}

// Four digits at least, without zeros at the end, and no exponent: 138,944, 0.01234 and 5.
std::string figure(double value) {
  if (!std::isfinite(value)) return "";
  const double size = std::fabs(value) > 0 ? std::floor(std::log10(std::fabs(value))) : 0;
  std::string text = fixed(value, static_cast<int>(std::clamp(3 - size, 0.0, 12.0)));
  if (text.find('.') != text.npos) text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  for (std::size_t at = std::min(text.find('.'), text.size()); at > 3 && text[at - 4] != '-'; at -= 3)
    text.insert(at - 3, ",");
  return text;
}

std::string length(double value, std::string_view unit) {
  return figure(value) + (unit.empty() ? "" : " ") + std::string(unit);
}

std::string area(double value, std::string_view unit) {
  return length(value, unit) + (unit.empty() ? "" : "²");
}

std::string share(double value) {
  return fixed(100 * value, value < 0.9995 ? 2 : 3) + " %";
}

std::string_view source_of(std::string_view rule) {
  if (rule.starts_with("anps:"))
    return "U.S. Geological Survey, Lidar Base Specification: a data void has four nominal spacings";
  if (rule.starts_with("spacing2:"))
    return "English Heritage, draft specification for laser scanning: twice the nominal spacing";
  return "a length, as it was ordered";
}

using Pairs = std::vector<std::pair<std::string, std::string>>;

std::string description(const Pairs& pairs) {
  std::string html = "<dl class=\"pairs\">\n";
  for (const auto& [name, value] : pairs)
    html += "<div><dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd></div>\n";
  return html + "</dl>\n";
}

// ---- the map

class SheetMap {
 public:
  SheetMap(const AreaCheck& check, std::string_view unit) : check_(check), unit_(unit) {
    for (const AreaPolygon& polygon : check.polygons)
      for (const Ring2& ring : polygon.outline)
        for (const Eigen::Vector2d& corner : ring) box_.extend(corner);
    if (!box_.isEmpty() && box_.sizes().maxCoeff() > 0) scale_ = kWidth / box_.sizes().maxCoeff();
  }

  std::string print() const {
    if (box_.isEmpty()) return "";
    const Eigen::Vector2d size = box_.sizes() * scale_;
    std::string svg =
        "<svg class=\"area-map\" role=\"img\" aria-label=\"Map of the density and of the voids\" "
        "viewBox=\"-4 -4 " +
        fixed(size.x() + 8, 1) + " " + fixed(size.y() + 26, 1) + "\">\n";
    for (const AreaPolygon& polygon : check_.polygons) svg += path(polygon.outline, "sheet", "");
    const double most = most_density();
    for (const AreaTile& tile : check_.tiles) {
      const double density = tile.density();
      if (!(density > 0) || !(most > 0)) continue;
      const double e = check_.tile_edge, x = tile.corner.x(), y = tile.corner.y();
      svg += path({{{x, y}, {x + e, y}, {x + e, y + e}, {x, y + e}}}, "tile",
                  " fill-opacity=\"" + fixed(std::min(1.0, density / most) * 0.75, 2) + "\"");
    }
    const auto voids = std::span(check_.voids).first(std::min(check_.voids.size(), kMostOnMap));
    for (const Void& each : voids) svg += path(each.outline, each.counts ? "counts" : "excepted", "");
    for (std::size_t id = 0; id < std::min(voids.size(), kMostRows); ++id) {
      const Eigen::Vector2d at = place(voids[id].middle);
      svg += "<text x=\"" + fixed(at.x(), 1) + "\" y=\"" + fixed(at.y(), 1) + "\">" + std::to_string(id) +
             "</text>\n";
    }
    return svg + bar(size) + "</svg>\n<p class=\"quiet\">" + legend(most) + "</p>\n";
  }

 private:
  static constexpr double kWidth = 600;

  Eigen::Vector2d place(const Eigen::Vector2d& corner) const {
    return {(corner.x() - box_.min().x()) * scale_, (box_.max().y() - corner.y()) * scale_};
  }

  // Corners nearer than a third of a pixel to the one before are left out.
  std::string path(const PlanPolygon& outline, std::string_view style, const std::string& more) const {
    constexpr double kLeast = 1. / 3;
    std::string d;
    for (const Ring2& ring : outline) {
      Eigen::Vector2d last(HUGE_VAL, 0);
      for (const Eigen::Vector2d& corner : ring) {
        const Eigen::Vector2d at = place(corner);
        if ((at - last).norm() < kLeast) continue;
        d += (std::isinf(last.x()) ? "M" : "L") + fixed(at.x(), 1) + " " + fixed(at.y(), 1);
        last = at;
      }
      d += "Z";
    }
    return "<path class=\"" + std::string(style) + "\" fill-rule=\"evenodd\"" + more + " d=\"" + d + "\"/>\n";
  }

  // Leaves out the densest twentieth of the squares: overlaps would make all others pale.
  double most_density() const {
    constexpr double kQuantile = 0.95;
    std::vector<double> densities;
    for (const AreaTile& tile : check_.tiles)
      if (std::isfinite(tile.density()) && tile.points > 0) densities.push_back(tile.density());
    if (densities.empty()) return 0;
    const auto at = densities.begin() +
                    static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(densities.size() - 1));
    std::nth_element(densities.begin(), at, densities.end());
    return *at;
  }

  std::string bar(const Eigen::Vector2d& size) const {
    constexpr double kOfWidth = 0.2;
    const double wanted = kOfWidth * box_.sizes().maxCoeff();
    const double power = std::pow(10, std::floor(std::log10(wanted)));
    const double long_one = wanted >= 5 * power ? 5 * power : wanted >= 2 * power ? 2 * power : power;
    const std::string y = fixed(size.y() + 10, 1), end = fixed(long_one * scale_, 1);
    return "<path class=\"sheet\" d=\"M0 " + y + "H" + end + "\"/>\n<text x=\"" + end + "\" dx=\"4\" y=\"" +
           y + "\" dy=\"3\">" + escaped(length(long_one, unit_)) + "</text>\n";
  }

  std::string legend(double most) const {
    std::string text = "Orange: voids that count, with their ids. ";
    if (most > 0)
      text += "Blue: density of the points, by squares of " + escaped(length(check_.tile_edge, unit_)) +
              "; darkest at " + figure(most) + " or more in a square of 1" +
              (unit_.empty() ? "" : " " + escaped(unit_)) + ". ";
    return text + "x to the right, y to the top.";
  }

  const AreaCheck& check_;
  std::string_view unit_;
  Eigen::AlignedBox2d box_;
  double scale_ = 1;
};

// ---- the sheet

std::string answer_of(const AreaCheck& check, std::string_view unit) {
  const std::size_t counting = check.counting();
  std::string text(name_of(check.answer()));
  for (const Undecided reason : check.undecided)
    text.append(reason == check.undecided.front() ? ": " : ", ").append(name_of(reason));
  if (check.undecided.empty() && counting > 0)
    text += ": " + std::to_string(counting) + " of " + length(check.void_size, unit) + " or more";
  return text;
}

Pairs figures_of(const AreaCheck& check, const AreaSheet& sheet, const AreaConfig& config) {
  const std::string_view unit = sheet.unit;
  const std::size_t excepted = check.voids.size() - check.counting();
  Pairs pairs = {{"Rule", config.void_rule + ": voids of " + length(check.void_size, unit) + " or more"},
                 {"Source", std::string(source_of(config.void_rule))},
                 {"Area", area(check.area, unit)}};
  if (check.answer() != AreaAnswer::kNotDecided && check.area > 0)
    pairs.emplace_back("Covered", share(1 - check.missing_area / check.area));
  pairs.emplace_back("Voids that count",
                     std::to_string(check.counting()) + ", " + area(check.missing_area, unit));
  if (excepted > 0) pairs.emplace_back("Voids in exceptions", std::to_string(excepted));
  for (const AreaClass& each : check.classes)
    pairs.emplace_back("Of voids, in " + each.name, area(each.voids_area, unit));
  pairs.emplace_back("Points", figure(static_cast<double>(check.points)));
  pairs.emplace_back("Unit", unit.empty() ? "not stated" : std::string(unit));
  pairs.emplace_back("CRS", sheet.crs.empty() ? "not stated" : name_of_crs(sheet.crs));
  return pairs;
}

std::string table_of(const AreaCheck& check, std::string_view unit) {
  if (check.voids.empty()) return "";
  const std::size_t shown = std::min(check.voids.size(), kMostRows);
  std::string html =
      "<table class=\"print-table\"><caption>" +
      (shown < check.voids.size() ? "The " + std::to_string(shown) + " largest of " +
                                        std::to_string(check.voids.size()) + " voids; voids.csv has all"
                                  : std::string("Voids")) +
      "</caption><thead><tr>";
  for (const char* const title : {"Id", "Kind", "Area", "Largest circle", "x", "y", "In exceptions"})
    html += std::string("<th scope=\"col\">") + title + "</th>";
  html += "</tr></thead><tbody>\n";
  const int decimals = static_cast<int>(std::clamp(2 - std::floor(std::log10(check.void_size)), 0.0, 9.0));
  for (std::size_t id = 0; id < shown; ++id) {
    const Void& each = check.voids[id];
    html += "<tr>";
    for (const std::string& cell :
         {std::to_string(id), std::string(name_of(each.kind)), area(each.area, unit),
          length(each.circle, unit), fixed(each.middle.x(), decimals), fixed(each.middle.y(), decimals),
          share(each.excepted)})
      html += "<td>" + escaped(cell) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

std::string basis_of(const AreaCheck& check) {
  Pairs pairs;
  for (const auto& [thing, what] : check.basis) pairs.emplace_back(thing, what);
  std::string html =
      "<div><h3>Basis</h3>\n" + description(pairs) + "</div><div><h3>This check does not show</h3>\n<ul>\n";
  for (const std::string_view each : kNotShown) html += "<li>" + escaped(each) + "</li>\n";
  return html + "</ul></div>\n";
}

// The style of the report of a run, with its rules for paper in effect everywhere.
std::string style() {
  constexpr std::string_view kBegin = "<style>", kEnd = "</style>", kPaper = "@media print";
  const std::size_t begin = kReportPage.find(kBegin) + kBegin.size();
  std::string css(kReportPage.substr(begin, kReportPage.find(kEnd, begin) - begin));
  for (std::size_t at = css.find(kPaper); at != css.npos; at = css.find(kPaper, at))
    css.replace(at, kPaper.size(), "@media all");
  return css.append(kSheetStyle);
}

}  // namespace

void write_area_sheet(const AreaCheck& check, const AreaSheet& sheet, const AreaConfig& config,
                      OutputFile& out) {
  out.write(std::string(kReportMark) +
            ": check of an area -->\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n" +
            "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
            "'unsafe-inline'\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
            "<title>Check of " + escaped(sheet.title) + "</title>\n<style>" + style() +
            "</style></head>\n<body><main class=\"print\">\n");
  out.write("<header class=\"print-head\"><h1>Is the area covered?</h1><span>" + escaped(sheet.title) +
            ", by lacuna check</span></header>\n<div class=\"fields\">\n");
  for (const char* const field : {"Project", "Client", "Surveyed on", "Checked on", "Checked by", "Accepted"})
    out.write(std::string("<label>") + field + " <input></label>\n");
  out.write("</div>\n<p class=\"answer" + std::string(check.is_covered() ? "" : " no") + "\">" +
            escaped(answer_of(check, sheet.unit)) + "</p>\n");
  out.write(SheetMap(check, sheet.unit).print());
  out.write("<div class=\"figures\">" + description(figures_of(check, sheet, config)) + "</div>\n" +
            table_of(check, sheet.unit));
  out.write("<div class=\"print-columns\">" + basis_of(check) + "</div>\n</main></body></html>\n");
}

}  // namespace lacuna::io
