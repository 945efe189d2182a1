// SPDX-License-Identifier: Apache-2.0
#include "io/write/report/scene.hpp"

#include "engine/run/error.hpp"
#include "io/explain/stations/find_causes.hpp"
#include "io/read/formats.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/write/report/report.hpp"

#include <numeric>
#include <utility>

namespace lacuna::io {
namespace {

constexpr float kRounded = 1.01f;                               // the most that a colour from 0 to 1 may be
constexpr std::pair<double, double> kStretched = {0.02, 0.98};  // percentiles

// The values that become 0 and 255.
std::pair<float, float> range_of(std::span<const float> values, bool is_intensity, Scalar type) {
  if (is_intensity) {
    std::vector<float> sorted(values.begin(), values.end());
    return {percentile(sorted, kStretched.first), percentile(sorted, kStretched.second)};
  }
  const float most = *std::max_element(values.begin(), values.end());
  if (!is_integer(type) && most <= kRounded) return {0.0f, 1.0f};
  return {0.0f, most > 255 ? 65535.0f : 255.0f};
}

}  // namespace

ColourColumns::ColourColumns(const RowLayout& layout) : layout_(layout) {
  const auto [red, green, blue, intensity] = kColourNames;
  if (layout.find(red) && layout.find(green) && layout.find(blue)) {
    properties_ = {layout.find(red), layout.find(green), layout.find(blue)};
  } else if (layout.find(intensity)) {
    properties_ = {layout.find(intensity)};
  }
  loaded_.resize(properties_.size());
}

void ColourColumns::load(const RowBatch& rows) {
  for (std::size_t i = 0; i < properties_.size(); ++i) {
    load_column(rows, layout_.stride, *properties_[i], loaded_[i]);
  }
}

void ColourColumns::take(std::size_t row) {
  for (const std::vector<double>& column : loaded_) {
    taken_.push_back(std::isfinite(column[row]) ? static_cast<float>(column[row]) : 0.0f);
  }
}

void ColourColumns::begin_file() {
  if (taken_.size() > files_.back()) files_.push_back(taken_.size());
}

std::vector<Colour> ColourColumns::finish() const {
  std::vector<Colour> colours;
  if (taken_.empty()) return colours;
  const std::size_t width = properties_.size();
  const bool is_intensity = width == 1;
  colours.reserve(taken_.size() / width);
  for (std::size_t file = 0; file < files_.size(); ++file) {
    const bool is_last = is_intensity || file + 1 == files_.size();  // one range of all intensities
    const std::size_t end = is_last ? taken_.size() : files_[file + 1];
    const std::span values(taken_.data() + files_[file], end - files_[file]);
    if (values.empty()) break;
    const auto [low, high] = range_of(values, is_intensity, properties_.front()->type);
    const auto byte = [low = low, span = std::max(high - low, 1e-30f)](float value) {
      return static_cast<std::uint8_t>(std::clamp((value - low) / span, 0.0f, 1.0f) * 255.0f + 0.5f);
    };
    for (std::size_t i = 0; i < values.size(); i += width)
      colours.push_back({byte(values[i]), byte(values[i + width / 3]), byte(values[i + 2 * (width / 3)])});
    if (is_last) break;
  }
  return colours;
}

namespace {

namespace fs = std::filesystem;
using Event = Json::parse_event_t;

constexpr std::size_t kRowsAtATime = 1 << 16;
constexpr double kSpacing = 0.6;  // edge of the square of a point over the distance of neighbours

double number(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

Eigen::Vector3d vector(const Json& values) {
  return {number(values.at(0)), number(values.at(1)), number(values.at(2))};
}

LoopCause cause_of(const Json& record) {
  LoopCause cause;
  if (record.is_null()) return cause;
  for (std::size_t i = 0; i < kCauses; ++i) cause.shares[i] = number(record.at("shares").at(kCauseNames[i]));
  if (const Json& hidden_by = record.at("hidden_by"); !hidden_by.is_null()) {
    cause.hidden_by = vector(hidden_by.at("place"));
    cause.hidden_by_extent = number(hidden_by.at("extent"));
    cause.hidden_from = hidden_by.at("station").get<std::int32_t>();
    cause.hidden_from_place = vector(hidden_by.at("from"));
  }
  return cause;
}

ExplainedLoop measures_of(const Json& record) {
  return {{.kind = record.at("kind") == name_of(LoopKind::kHole) ? LoopKind::kHole : LoopKind::kOuter,
           .points = record.at("points").get<std::uint64_t>(),
           .perimeter = number(record.at("perimeter")),
           .area = number(record.at("area")),
           .diameter = number(record.at("diameter")),
           .centroid = vector(record.at("centroid")),
           .normal = vector(record.at("normal")),
           .planarity = number(record.at("planarity")),
           .mean_probability = number(record.at("mean_probability")),
           .track = {.confidence = number(record.at("confidence")),
                     .evidence = {.spacing = number(record.at("evidence").at("spacing")),
                                  .width = number(record.at("evidence").at("width")),
                                  .prominence = number(record.at("prominence"))},
                     .first_scale = number(record.at("first_scale")),
                     .last_scale = number(record.at("last_scale"))},
           .tiles = record.at("tiles").get<std::uint64_t>(),
           .parent = record.at("parent").is_null() ? -1 : record.at("parent").get<std::int64_t>()},
          cause_of(record.value("cause", Json()))};
}

// The head of holes.json and the measures of all loops; one loop is in memory at a time, without its points.
void read_holes(const fs::path& file, std::size_t most, Scene& scene) {
  if (!fs::exists(file)) throw Error(file.string() + ": is not there; the folder of a lacuna detect has it");
  bool is_in_loops = false;
  const auto keep = [&](int depth, Event event, Json& parsed) {
    if (depth == 1 && event == Event::key) is_in_loops = parsed == "loops";
    if (!is_in_loops) return true;
    if (depth == 3 && event == Event::key) return parsed != "ids" && parsed != "coordinates";
    if (depth != 2 || event != Event::object_end) return true;
    if (scene.loops.ids.size() == most)
      throw Error(file.string() + ": more than the " + std::to_string(most) +
                  " loops that fit in the memory limit; --memory-limit states a larger one");
    scene.loops.ids.push_back(parsed.at("id").get<std::uint64_t>());
    scene.loops.measures.push_back(measures_of(parsed));
    return false;
  };
  try {
    scene.holes = read_json(file, kResultOfDetect, keep);
    if (scene.holes.at("schema") != kHolesSchema) {
      throw Error(file.string() + ": its schema is " + print(scene.holes.at("schema"), -1) + "; \"" +
                  std::string(kHolesSchema) + "\" is read");
    }
    // It is that of one point, until the sample has been read.
    scene.points.spacing = static_cast<float>(kSpacing * number(scene.holes.at("median_distance")) *
                                              std::sqrt(scene.holes.at("counts").at("points").get<double>()));
    const Json& strays = scene.holes.at("strays");
    scene.strays = strays.at("points").get<std::uint64_t>();
    if (const Json& rest = strays.at("rest"); !rest.is_null()) {
      scene.bounds = {vector(rest.at("min")), vector(rest.at("max"))};
      scene.origin = scene.bounds.min();
      if (const double edge = scene.bounds.sizes().maxCoeff(); edge > 0) scene.edge = edge;
      if (!scene.holes.at("offset").is_null()) scene.rounding = 0x1p-22 * (scene.edge + 1);
    }
  } catch (const Json::exception& error) {
    throw Error(file.string() + ": is not as lacuna detect writes it: " + error.what());
  }
  scene.loops.all = scene.loops.ids.size();
}

const Property& find(const fs::path& file, const RowLayout& layout, std::string_view name) {
  const Property* property = layout.find(name);
  if (!property) {
    throw Error(file.string() + ": element 'vertex' has no property '" + std::string(name) +
                "'; files as lacuna detect writes them have it");
  }
  return *property;
}

// Whether a position lies outside of the bounds, by more than its rounding.
bool is_stray(const Scene& scene, const Eigen::Vector3d& position) {
  if (scene.strays == 0) return false;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(scene.rounding);
  return !Eigen::AlignedBox3d(scene.bounds.min() - margin, scene.bounds.max() + margin).contains(position);
}

// Returns the position relative to the scene's origin. A position that rounding has put outside of the bounds
// lies on them.
Eigen::Vector3f place_in(const Scene& scene, const Eigen::Vector3d& position) {
  Eigen::Vector3d inside = position;
  if (scene.rounding > 0) inside = position.cwiseMax(scene.bounds.min()).cwiseMin(scene.bounds.max());
  return (inside - scene.origin).cast<float>();
}

void read_points(const fs::path& file, std::size_t most, Scene& scene) {
  if (!fs::exists(file)) return;
  const std::unique_ptr<ScanReader> reader = open_scan(file, {});
  const RowLayout& layout = reader->layout();
  const Property& probability = find(file, layout, "scalar_probability");
  for (const char* const name : kNormalNames) find(file, layout, name);
  const std::uint64_t rows = reader->expected_rows().value_or(0);
  const std::uint64_t wanted = std::min<std::uint64_t>(rows, most);

  const Property& id = find(file, layout, "scalar_id");
  const Json inputs = scene.holes.value("inputs", Json::array());
  std::size_t next_input = 1;

  ColourColumns colours(layout);
  std::vector<Eigen::Vector3d> positions, normals;
  std::vector<double> probabilities, ids;
  std::uint64_t taken = 0, before = 0;
  for (RowBatch batch; reader->next(batch, kRowsAtATime); before += batch.count) {
    load_vectors(batch, layout, kPositionNames, positions);
    load_vectors(batch, layout, kNormalNames, normals);
    load_column(batch, layout.stride, probability, probabilities);
    load_column(batch, layout.stride, id, ids);
    colours.load(batch);
    for (; taken < wanted && taken * rows / wanted < before + batch.count; ++taken) {
      const std::size_t i = taken * rows / wanted - before;
      if (is_stray(scene, positions[i])) continue;
      const Eigen::Vector3f normal = normals[i].cast<float>();
      scene.points.positions.push_back(place_in(scene, positions[i]));
      scene.points.normals.push_back(normal.allFinite() ? normal : Eigen::Vector3f(0, 0, 0));
      scene.points.probabilities.push_back(static_cast<float>(probabilities[i]));
      for (; next_input < inputs.size() && ids[i] >= inputs[next_input].at("first_id"); ++next_input)
        colours.begin_file();
      colours.take(i);
    }
  }
  scene.points.colours = colours.finish();
}

// Returns whether each loop is shown: the loops with the largest perimeters, until a limit.
std::vector<bool> choose_loops(const std::vector<ExplainedLoop>& loops, const SceneLimits& limits) {
  std::vector<std::size_t> order(loops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return loops[a].perimeter > loops[b].perimeter; });
  std::vector<bool> is_shown(loops.size());
  std::size_t taken = 0;
  std::uint64_t vertices = 0;
  for (const std::size_t loop : order) {
    vertices += loops[loop].points;
    if (taken++ == limits.loops || vertices > limits.positions / 4) break;
    is_shown[loop] = true;
  }
  return is_shown;
}

// The loops that are shown stay in `scene`, with their vertices.
void read_loops(const fs::path& file, const SceneLimits& limits, Scene& scene) {
  Scene::Loops& loops = scene.loops;
  const std::vector<bool> is_shown = choose_loops(loops.measures, limits);
  const std::unique_ptr<ScanReader> reader = open_scan(file, {});
  const RowLayout& layout = reader->layout();
  const Property& loop_property = find(file, layout, "scalar_loop");
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> loop_of;
  std::vector<std::size_t> lengths(is_shown.size());
  std::vector<bool> has_stray(is_shown.size());
  for (RowBatch batch; reader->next(batch, kRowsAtATime);) {
    load_vectors(batch, layout, kPositionNames, positions);
    load_column(batch, layout.stride, loop_property, loop_of);
    for (std::size_t i = 0; i < batch.count; ++i) {
      if (!(loop_of[i] >= 0 && loop_of[i] < static_cast<double>(is_shown.size()))) {
        throw Error(file.string() + ": a vertex is of loop " + std::to_string(loop_of[i]) +
                    ", of which holes.json has none; both must be of one run");
      }
      const auto loop = static_cast<std::size_t>(loop_of[i]);
      if (!is_shown[loop]) continue;
      ++lengths[loop];
      if (is_stray(scene, positions[i])) has_stray[loop] = true;
      loops.vertices.push_back(place_in(scene, positions[i]));
    }
  }
  std::size_t kept = 0;
  auto vertices = loops.vertices.begin(), drawn = vertices;  // read, and kept
  loops.first = {0};
  for (std::size_t loop = 0; loop < is_shown.size(); ++loop) {
    if (!is_shown[loop]) continue;
    if (lengths[loop] != loops.measures[loop].points) {
      throw Error(file.string() + ": loop " + std::to_string(loops.ids[loop]) + " has " +
                  std::to_string(lengths[loop]) + " vertices, in holes.json " +
                  std::to_string(loops.measures[loop].points) + "; both must be of one run");
    }
    loops.ids[kept] = loops.ids[loop];
    loops.measures[kept++] = loops.measures[loop];
    const auto end = vertices + static_cast<std::ptrdiff_t>(lengths[loop]);
    if (!has_stray[loop]) drawn = std::move(vertices, end, drawn);
    vertices = end;
    loops.first.push_back(static_cast<std::size_t>(drawn - loops.vertices.begin()));
  }
  loops.vertices.erase(drawn, loops.vertices.end());
  loops.ids.resize(kept);
  loops.measures.resize(kept);
}

}  // namespace

SceneLimits limits_within(std::uint64_t memory) {
  constexpr std::size_t kPosition = 120, kLoop = 3 * sizeof(ExplainedLoop);  // bytes, while arrays grow
  SceneLimits limits;
  limits.positions = std::min<std::size_t>(limits.positions, memory / kPosition);
  limits.all_loops = memory / 2 / kLoop;
  return limits;
}

Scene read_scene(const fs::path& folder, const SceneLimits& limits) {
  if (!fs::is_directory(folder))
    throw Error(folder.string() + ": not a folder; allowed: a folder with results of lacuna detect");
  Scene scene;
  read_holes(folder / "holes.json", limits.all_loops, scene);
  read_loops(folder / "loops.ply", limits, scene);
  read_points(folder / "sample.ply", limits.positions - scene.loops.vertices.size(), scene);
  const auto drawn = static_cast<float>(scene.points.positions.size());
  scene.points.spacing = drawn > 1 ? scene.points.spacing / std::sqrt(drawn) : 0;
  return scene;
}

void extend(Scene& scene, const Eigen::AlignedBox3d& places) {
  Eigen::AlignedBox3d box(scene.origin, scene.origin + Eigen::Vector3d::Constant(scene.edge));
  box.extend(places);
  const Eigen::Vector3f moved = (scene.origin - box.min()).cast<float>();
  for (Eigen::Vector3f& position : scene.points.positions) position += moved;
  for (Eigen::Vector3f& vertex : scene.loops.vertices) vertex += moved;
  scene.origin = box.min();
  scene.edge = box.sizes().maxCoeff();
}

Json read_next_stations(const fs::path& folder) {
  const fs::path file = folder / kNextStationsFile;
  if (!fs::exists(file)) return nullptr;
  const Json collection = read_json(file, "a result of lacuna stations");
  Json stations = Json::array();
  try {
    for (const Json& feature : collection.at("features")) {
      const Json& properties = feature.at("properties");
      stations.push_back({{"rank", properties.at("rank").get<std::uint64_t>()},
                          {"place",
                           {properties.at("x").get<double>(), properties.at("y").get<double>(),
                            properties.at("z").get<double>()}},
                          {"area", properties.at("area").get<double>()},
                          {"share", properties.at("share").get<double>()}});
    }
  } catch (const Json::exception& error) {
    throw Error(file.string() + ": is not as lacuna stations writes it: " + error.what());
  }
  return stations;
}

namespace {

constexpr int kCells = 24, kLayers = 96;   // along each side of the plan; of the heights
constexpr int kRoom = 15;                  // layers: least empty space below a ceiling
constexpr int kCeiling = 8, kSurface = 4;  // layers: of the ceilings of a storey, of one surface
constexpr double kLeastCovered = 0.07;     // share of the columns

std::pair<float, float> narrowest(std::vector<float>& values, double share, float margin) {
  std::ranges::sort(values);
  const auto steps = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::size_t at = 0;
  for (std::size_t i = 1; i + steps < values.size(); ++i)
    if (values[i + steps] - values[i] < values[at + steps] - values[at]) at = i;
  const float more = margin * (values[at + steps] - values[at]);
  return {std::max(values.front(), values[at] - more), std::min(values.back(), values[at + steps] + more)};
}

}  // namespace

std::pair<float, float> most_of(std::vector<float>& values, double share) {
  return narrowest(values, share, 0.15f);
}

// Idea: the plan is cut into columns. A ceiling is where the empty space of many columns ends at about one
// height, below level points. Columns with a floor and nothing above it speak against it.
std::vector<double> ceiling_cuts(const Scene& scene) {
  const std::vector<Eigen::Vector3f>& positions = scene.points.positions;
  if (positions.empty()) return {};
  struct Column {
    std::array<int, kLayers + kSurface> points{}, level{};
  };
  std::vector<Column> columns(kCells * kCells);
  std::array<std::pair<float, float>, 3> ranges;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (const Eigen::Vector3f& p : positions) values.push_back(p[axis]);
    ranges[std::size_t(axis)] = narrowest(values, 0.99, 0.02f);
  }
  constexpr float kFlat = 0.02f;  // height over width: no storey, whatever layers chance leaves empty
  const auto extent = [&](int axis) {
    return ranges[std::size_t(axis)].second - ranges[std::size_t(axis)].first;
  };
  if (extent(2) < kFlat * std::max(extent(0), extent(1))) return {};
  const auto part_of = [&](const Eigen::Vector3f& p, std::size_t axis, int parts) {
    const auto [low, high] = ranges[axis];
    const float part = float(parts) * (p[int(axis)] - low) / std::max(1e-30f, high - low);
    return part >= 0 && part <= float(parts) ? std::min(int(part), parts - 1) : -1;
  };
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const int x = part_of(positions[i], 0, kCells), y = part_of(positions[i], 1, kCells);
    const int z = part_of(positions[i], 2, kLayers);
    if (std::min({x, y, z}) < 0) continue;
    Column& column = columns[std::size_t(x * kCells + y)];
    ++column.points[std::size_t(z)];
    column.level[std::size_t(z)] += std::abs(scene.points.normals[i].z()) > 0.8f;
  }
  int occupied = 0;
  std::array<int, kLayers> covered{}, ends{}, open{};  // columns, by layer
  const auto count = [](std::array<int, kLayers>& counts, int from, int to) {
    for (int layer = std::max(0, from); layer <= to; ++layer) ++counts[std::size_t(layer)];
  };
  for (const Column& column : columns) {
    const int all = std::reduce(column.points.begin(), column.points.end());
    const auto is_level = [&](int layer) {
      const auto sum = [layer](const auto& counts) {
        return std::accumulate(counts.begin() + layer, counts.begin() + layer + kSurface, 0);
      };
      return 2 * sum(column.level) >= sum(column.points);
    };
    int last = -1;
    for (int layer = 0; layer < kLayers; ++layer) {
      if (100 * column.points[std::size_t(layer)] <= all) continue;
      if (last >= 0 && layer - last > kRoom && is_level(layer)) {
        count(covered, last + 2, layer);
        count(ends, layer - kCeiling + 1, layer);
      }
      last = layer;
    }
    occupied += last >= 0;
    if (last >= 0 && is_level(std::max(0, last + 1 - kSurface))) count(open, last + 1, kLayers - 1);
  }
  std::vector<double> cuts;
  const auto [bottom, top] = ranges[2];
  for (int layer = kLayers - 1, best = 0, most = 0; layer >= 0; --layer) {
    const auto at = std::size_t(layer);
    const bool is_ceiling = ends[at] > 0 && covered[at] >= kLeastCovered * occupied &&
                            covered[at] >= open[at] && 2 * ends[at] >= covered[at];
    if (is_ceiling && ends[at] > most) best = layer, most = ends[at];
    if (most == 0 || (is_ceiling && layer >= best - kCeiling)) continue;
    cuts.push_back(scene.origin.z() + bottom + double(best - 3) / kLayers * (top - bottom));
    layer = best - kRoom;  // the next storey
    most = 0;
  }
  return cuts;
}

std::vector<bool> small_loops(const Scene::Loops& loops) {
  std::vector<bool> are_small;
  for (const ExplainedLoop& loop : loops.measures) are_small.push_back(loop.track.evidence.is_small());
  if (std::ranges::count(are_small, true) < kLeastSmall) are_small.assign(are_small.size(), false);
  return are_small;
}

}  // namespace lacuna::io
