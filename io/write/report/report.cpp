// SPDX-License-Identifier: Apache-2.0
#include "io/write/report/report.hpp"

#include "engine/run/error.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/read/files/number.hpp"
#include "io/read/files/output_file.hpp"
#include "io/write/loops/loop_measures.hpp"
#include "io/write/report/scene.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {
namespace {

// Bytes as text (RFC 4648), in one line.
class Base64 {
 public:
  explicit Base64(OutputFile& out) : out_(out) {}

  void write(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) {
      bits_ = bits_ << 8 | std::to_integer<std::uint32_t>(byte);
      if (++held_ == 3) put(4);
    }
  }
  void finish() {  // once, at the end
    const std::size_t held = held_;
    if (held == 0) return;
    bits_ <<= 8 * (3 - held);
    put(held + 1);
    out_.write(std::string_view("==").substr(held - 1));
  }

 private:
  void put(std::size_t digits) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char text[4];
    for (std::size_t i = 0; i < 4; ++i) text[i] = kDigits[bits_ >> (18 - 6 * i) & 63];
    out_.write(std::string_view(text, digits));
    bits_ = 0;
    held_ = 0;
  }

  OutputFile& out_;
  std::uint32_t bits_ = 0;
  std::size_t held_ = 0;  // bytes in `bits_`
};

namespace fs = std::filesystem;

constexpr int kBits = 21;  // of a coordinate: three in eight bytes

std::uint64_t packed(const Eigen::Vector3f& position, double edge) {
  std::uint64_t bits = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const double steps = position[axis] / edge * (1 << kBits);
    bits = bits << kBits | static_cast<std::uint64_t>(std::clamp(steps, 0.0, double((1 << kBits) - 1)));
  }
  return bits;
}

// Octahedral coding: a unit vector in two bytes (Meyer, Suessmuth, Sussner, Stamminger, Greiner, 2010).
std::array<std::int8_t, 2> octahedral(const Eigen::Vector3f& normal) {
  const float sum = normal.cwiseAbs().sum();
  if (!(sum > 0)) return {0, 0};
  float u = normal.x() / sum, v = normal.y() / sum;
  if (normal.z() < 0) {
    const float folded = (1 - std::abs(v)) * (u < 0 ? -1.0f : 1.0f);
    v = (1 - std::abs(u)) * (v < 0 ? -1.0f : 1.0f);
    u = folded;
  }
  return {static_cast<std::int8_t>(std::lround(u * 127)), static_cast<std::int8_t>(std::lround(v * 127))};
}

std::uint8_t byte_of(float probability) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(probability, 0.0f, 1.0f) * 255));
}

// Writes an element of the page with the bytes of all items.
template <class Items, class Encode>
void write_bytes(std::string_view id, const Items& items, Encode&& encode, OutputFile& out) {
  out.write("<script type=\"application/base64\" id=\"" + std::string(id) + "\">");
  Base64 base64(out);
  for (const auto& item : items) {
    const auto bytes = encode(item);
    base64.write(std::as_bytes(std::span(&bytes, 1)));
  }
  base64.finish();
  out.write("</script>\n");
}

std::string title_of(const Json& inputs) {
  if (inputs.size() != 1) return std::to_string(inputs.size()) + " files";
  return fs::path(inputs[0].at("file").get<std::string>()).filename().string();
}

Json inputs_of(const Json& inputs) {
  Json short_inputs = Json::array();
  for (const Json& input : inputs)
    short_inputs.push_back({{"file", input.at("file")}, {"points", input.at("points")}});
  return short_inputs;
}

// Six digits are more than a reader wants, and keep the page small.
double rounded(double value) {
  return reread(value, std::chars_format::general, 6);
}

Json loops_of(const Scene::Loops& loops, int decimals) {
  Json json = {{"shown", loops.ids.size()}, {"all", loops.all}, {"id", loops.ids}};
  const auto add = [&](std::string_view name, auto&& value_of) {
    Json& column = json[std::string(name)] = Json::array();
    for (const ExplainedLoop& loop : loops.measures) column.push_back(value_of(loop));
  };
  add("kind", [](const ExplainedLoop& loop) { return Json(name_of(loop.kind)); });
  for (const LoopMeasure& measure : kLoopMeasures)
    add(measure.name, [&](const ExplainedLoop& loop) {
      const double value = measure.of(loop);
      return measure.is_count && std::isfinite(value) ? Json(static_cast<std::uint64_t>(value))
                                                      : Json(rounded(value));
    });
  add("centroid", [decimals](const ExplainedLoop& loop) {
    return list(loop.centroid.unaryExpr(
        [decimals](double value) { return reread(value, std::chars_format::fixed, decimals); }));
  });
  add("normal", [](const ExplainedLoop& loop) { return list(loop.normal.unaryExpr(&rounded)); });
  add("cause",
      [](const ExplainedLoop& loop) { return loop.cause.name().empty() ? Json() : Json(loop.cause.name()); });
  add("hidden_by", [](const ExplainedLoop& loop) {
    return loop.cause.hidden_from < 0 ? Json() : list(loop.cause.hidden_by);
  });
  add("hidden_from_place", [](const ExplainedLoop& loop) {
    return loop.cause.hidden_from < 0 ? Json() : list(loop.cause.hidden_from_place);
  });
  add("hidden_from", [](const ExplainedLoop& loop) { return Json(loop.cause.hidden_from); });
  json["small"] = small_loops(loops);
  json["small_below"] = LoopEvidence::kSmallWidth;
  json["first"] = loops.first;
  if (!loops.changes.empty()) {
    json["change"] = loops.changes;
    json["earlier"] = loops.earlier;
  }
  return json;
}

Json report_of(const Scene& scene) {
  const Json& holes = scene.holes;
  const Scene::Points& points = scene.points;
  return {{"lacuna", holes.at("lacuna")},
          {"title", title_of(holes.at("inputs"))},
          {"crs", holes.at("crs")},
          {"unit", holes.at("unit")},
          {"inputs", inputs_of(holes.at("inputs"))},
          {"counts", holes.at("counts")},
          {"bounds", corners(scene.bounds)},
          {"strays", scene.strays},
          {"compared", scene.compared},
          {"ceilings", ceiling_cuts(scene)},
          {"resolution", holes.at("resolution")},
          {"median_distance", holes.at("median_distance")},
          {"surface_area", holes.value("surface_area", 0.0)},
          {"hole_area", holes.value("hole_area", 0.0)},
          {"opening_area", holes.value("opening_area", Json())},
          {"stations", holes.value("stations", Json::array())},
          {"next_stations", scene.next_stations},
          {"frame", {{"origin", list(scene.origin)}, {"edge", scene.edge}}},
          {"sample",
           {{"points", points.positions.size()},
            {"of", holes.at("counts").at("points")},
            {"spacing", points.spacing},
            {"has_normals", true},
            {"has_colours", !points.colours.empty()}}},
          {"loops", loops_of(scene.loops, place_decimals(holes.at("median_distance").get<double>()))}};
}

// Writes an element of the page that holds the data as JSON.
void write_data(std::string_view id, const Json& data, OutputFile& out) {
  std::string text = "<script type=\"application/json\" id=\"" + std::string(id) + "\">";
  for (const char c : print(data, -1)) {  // the text never ends the element that it is in
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  out.write(text + "</script>\n");
}

}  // namespace

fs::path write_report(const fs::path& folder, Overwrite overwrite) {
  const fs::path file = folder / "report.html";
  check_output(file, kReportMark, overwrite);
  Scene scene = read_scene(folder);
  scene.next_stations = read_next_stations(folder);
  write_report(scene, file, overwrite);
  return file;
}

void write_report(const Scene& scene, const fs::path& file, Overwrite overwrite) {
  NewFile out(file, kReportMark, overwrite);
  write_report(scene, out.content());
  note_result(file.parent_path(), file.filename().string());
  out.commit();
}

void write_report(const Scene& scene, OutputFile& out) {
  const std::size_t data = kReportPage.find(kDataPlace);
  out.write(kReportPage.substr(0, data));
  Json report;
  try {
    report = report_of(scene);
  } catch (const Json::exception& error) {
    throw Error(out.path().string() + ": holes.json is not as lacuna detect writes it: " + error.what());
  }
  write_data("report", report, out);
  const auto position = [&](const Eigen::Vector3f& p) { return packed(p, scene.edge); };
  write_bytes("positions", scene.points.positions, position, out);
  write_bytes("probabilities", scene.points.probabilities, byte_of, out);
  write_bytes("normals", scene.points.normals, octahedral, out);
  if (!scene.points.colours.empty()) {
    write_bytes(
        "colours", scene.points.colours, [](const Colour& c) { return c; }, out);
  }
  write_bytes("loop_vertices", scene.loops.vertices, position, out);
  out.write(kReportPage.substr(data + kDataPlace.size()));
}

// The check of an area on pages: its section in the report of a run, and the sheet of a check.

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

// Returns voids.json with the largest voids and the first polygons alone, and with outlines as fine as a map
// shows them. Throws `Error` if it is not as Lacuna writes it.
Json read_area_section(const std::filesystem::path& file) {
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

}  // namespace

void write_area_sheet(const std::filesystem::path& folder, const std::string& title, OutputFile& out) {
  Json area = read_area_section(folder / kVoidsFile);
  area["title"] = title;
  const std::size_t data = kSheetPage.find(kDataPlace);
  out.write(kSheetPage.substr(0, data));
  write_data("area", area, out);
  out.write(kSheetPage.substr(data + kDataPlace.size()));
}

}  // namespace lacuna::io
