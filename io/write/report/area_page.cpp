// SPDX-License-Identifier: Apache-2.0
// The check of an area on pages: its section in the report of a run, and the sheet of a check.
#include "engine/run/error.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/write/report/report.hpp"

#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {
namespace {

constexpr std::size_t kMostVoids = 500, kMostOthers = 10'000;
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
    const std::size_t most = name_ == "voids" ? kMostVoids : kMostOthers;
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

void write_area_sheet(const std::filesystem::path& folder, const std::string& title, OutputFile& out) {
  Json area = read_area_section(folder);
  area["title"] = title;
  const std::size_t data = kSheetPage.find(kDataPlace);
  out.write(kSheetPage.substr(0, data));
  write_data("area", area, out);
  out.write(kSheetPage.substr(data + kDataPlace.size()));
}

}  // namespace lacuna::io
