#include "io/report/scene.hpp"

#include "engine/run/error.hpp"
#include "io/report/scene_colours.hpp"
#include "io/results/results.hpp"
#include "io/scalar.hpp"
#include "io/scan_reader.hpp"
#include "io/vectors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Event = nlohmann::detail::parse_event_t;

constexpr std::size_t kRowsAtATime = 1 << 16;

std::ifstream open_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file.string() + ": cannot be opened; the folder of a lacuna detect has it");
  return in;
}

double number(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

Eigen::Vector3d vector(const Json& values) {
  return {number(values.at(0)), number(values.at(1)), number(values.at(2))};
}

LoopMeasures measures_of(const Json& record) {
  return {.kind = record.at("kind") == name_of(LoopKind::kHole) ? LoopKind::kHole : LoopKind::kOuter,
          .points = record.at("points").get<std::uint64_t>(),
          .perimeter = number(record.at("perimeter")),
          .area = number(record.at("area")),
          .diameter = number(record.at("diameter")),
          .centroid = vector(record.at("centroid")),
          .normal = vector(record.at("normal")),
          .planarity = number(record.at("planarity")),
          .mean_probability = number(record.at("mean_probability")),
          .confidence = number(record.at("confidence")),
          .tiles = record.at("tiles").get<std::uint64_t>()};
}

// Bit i moves to bit 3 i, for 21 bits.
std::uint64_t spread_bits(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

// The head of holes.json and the measures of all loops; one loop is in memory at a time, without its points.
void read_holes(const fs::path& file, Scene& scene) {
  std::ifstream in = open_text(file);
  bool is_in_loops = false;
  const auto keep = [&](int depth, Event event, Json& parsed) {
    if (depth == 1 && event == Event::key) is_in_loops = parsed == "loops";
    if (!is_in_loops) return true;
    if (depth == 3 && event == Event::key) return parsed != "ids" && parsed != "coordinates";
    if (depth != 2 || event != Event::object_end) return true;
    scene.loops.ids.push_back(parsed.at("id").get<std::uint64_t>());
    scene.loops.measures.push_back(measures_of(parsed));
    return false;
  };
  try {
    scene.holes = Json::parse(in, keep);
    if (scene.holes.at("schema") != kHolesSchema) {
      throw Error(file.string() + ": its schema is " + print(scene.holes.at("schema"), -1) + "; \"" +
                  std::string(kHolesSchema) + "\" is read");
    }
    if (const Json& bounds = scene.holes.at("bounds"); !bounds.is_null()) {
      const Eigen::Vector3d min = vector(bounds.at("min")), max = vector(bounds.at("max"));
      scene.origin = min;
      if (const double edge = (max - min).maxCoeff(); edge > 0) scene.edge = edge;
    }
  } catch (const nlohmann::json::exception& error) {
    throw Error(file.string() + ": is not as lacuna detect writes it: " + error.what());
  }
  scene.loops.all = scene.loops.ids.size();
}

void read_run(const fs::path& file, Scene& scene) {
  if (!fs::exists(file)) return;
  std::ifstream in = open_text(file);
  try {
    scene.run = Json::parse(in);
  } catch (const nlohmann::json::exception& error) {
    throw Error(file.string() + ": is not JSON: " + error.what());
  }
}

const Property& find(const fs::path& file, const RowLayout& layout, std::string_view name) {
  const Property* property = layout.find(name);
  if (!property) {
    throw Error(file.string() + ": element 'vertex' has no property '" + std::string(name) +
                "'; files as lacuna detect writes them have it");
  }
  return *property;
}

void load_column(const RowBatch& rows, const RowLayout& layout, const Property& property,
                 std::vector<double>& values) {
  values.resize(rows.count);
  copy_column({.data = rows.bytes.data() + property.offset, .stride = layout.stride, .type = property.type},
              {.data = reinterpret_cast<std::byte*>(values.data()),
               .stride = sizeof(double),
               .type = Scalar::kFloat64},
              rows.count);
}

void read_points(const fs::path& file, std::size_t most, Scene& scene) {
  if (!fs::exists(file)) return;
  const std::unique_ptr<ScanReader> reader = open_scan(file, {});
  const RowLayout& layout = reader->layout();
  const Property& probability = find(file, layout, "scalar_probability");
  for (const char* const name : kNormalNames) find(file, layout, name);
  const std::uint64_t rows = reader->expected_rows().value_or(0);
  const std::uint64_t step = std::max<std::uint64_t>(1, (rows + most - 1) / most);  // one row of each step

  ColourColumns colours(layout);
  std::vector<Eigen::Vector3d> positions, normals;
  std::vector<double> probabilities;
  std::uint64_t next = 0, before = 0;
  for (RowBatch batch; reader->next(batch, kRowsAtATime); before += batch.count) {
    load_vectors(batch, layout, kPositionNames, positions);
    load_vectors(batch, layout, kNormalNames, normals);
    load_column(batch, layout, probability, probabilities);
    colours.load(batch);
    for (; next < before + batch.count; next += step) {
      const std::size_t i = next - before;
      const Eigen::Vector3f normal = normals[i].cast<float>();
      scene.points.positions.push_back((positions[i] - scene.origin).cast<float>());
      scene.points.normals.push_back(normal.allFinite() ? normal : Eigen::Vector3f(0, 0, 0));
      scene.points.probabilities.push_back(static_cast<float>(probabilities[i]));
      colours.take(i);
    }
  }
  scene.points.colours = colours.finish();
}

// Whether each loop is shown: those with the largest perimeters, until a limit.
std::vector<bool> choose_loops(const std::vector<LoopMeasures>& loops, const SceneLimits& limits) {
  std::vector<std::size_t> order(loops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return loops[a].perimeter > loops[b].perimeter; });
  std::vector<bool> is_shown(loops.size());
  std::size_t taken = 0;
  std::uint64_t vertices = 0;
  for (const std::size_t loop : order) {
    vertices += loops[loop].points;
    if (taken++ == limits.loops || vertices > limits.loop_vertices) break;
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
  for (RowBatch batch; reader->next(batch, kRowsAtATime);) {
    load_vectors(batch, layout, kPositionNames, positions);
    load_column(batch, layout, loop_property, loop_of);
    for (std::size_t i = 0; i < batch.count; ++i) {
      const auto loop = static_cast<std::size_t>(loop_of[i]);
      if (!(loop_of[i] >= 0) || loop >= is_shown.size()) {
        throw Error(file.string() + ": a vertex is of loop " + std::to_string(loop_of[i]) +
                    ", of which holes.json has none; both must be of one run");
      }
      if (!is_shown[loop]) continue;
      ++lengths[loop];
      loops.vertices.push_back((positions[i] - scene.origin).cast<float>());
    }
  }
  std::size_t kept = 0;
  loops.first = {0};
  for (std::size_t loop = 0; loop < is_shown.size(); ++loop) {
    if (!is_shown[loop]) continue;
    loops.ids[kept] = loops.ids[loop];
    loops.measures[kept++] = loops.measures[loop];
    loops.first.push_back(loops.first.back() + lengths[loop]);
  }
  loops.ids.resize(kept);
  loops.measures.resize(kept);
}

// From the number of cells that points lie in, where these have about eight each. Cells halve from the cube
// of the scene on: in the order of a Z curve, the first bit in which two points differ says where they part.
float typical_spacing(const Scene& scene) {
  constexpr int kLevels = 21;
  const auto& positions = scene.points.positions;
  if (positions.size() < 2) return 0;
  std::vector<std::uint64_t> codes;
  codes.reserve(positions.size());
  for (const Eigen::Vector3f& p : positions) {
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = std::clamp(p[axis] / scene.edge, 0.0, 1.0) * ((1 << kLevels) - 1);
      code |= spread_bits(static_cast<std::uint64_t>(at)) << axis;
    }
    codes.push_back(code);
  }
  std::sort(codes.begin(), codes.end());
  std::array<std::uint64_t, kLevels + 1> parted{};  // neighbours on the curve that part at a level, from 1
  for (std::size_t i = 1; i < codes.size(); ++i) {
    const int bits = std::bit_width(codes[i - 1] ^ codes[i]);
    if (bits > 0) ++parted[static_cast<std::size_t>(kLevels - (bits - 1) / 3)];
  }
  const auto points = static_cast<double>(codes.size());
  std::uint64_t cells = 1;
  int level = 0;
  while (level < kLevels && points > 8 * static_cast<double>(cells))
    cells += parted[static_cast<std::size_t>(++level)];
  // A surface passes through about one and a half times as many cells as its area needs.
  return static_cast<float>(std::ldexp(scene.edge, -level) *
                            std::sqrt(static_cast<double>(cells) / points / 1.5));
}

// The box from the 1st to the 99th percentile of each axis, with as much around it, and the loops' middles.
void frame(Scene& scene) {
  const auto& positions = scene.points.positions.empty() ? scene.loops.vertices : scene.points.positions;
  if (positions.empty()) return;
  Eigen::Vector3f low, high;
  std::vector<float> values(positions.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(positions.begin(), positions.end(), values.begin(),
                   [axis](const Eigen::Vector3f& p) { return p[axis]; });
    const auto percentile = [&](double share) {
      const auto at = values.begin() + std::llround(share * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), at, values.end());
      return *at;
    };
    low[axis] = percentile(0.01);
    high[axis] = percentile(0.99);
  }
  scene.middle = (low + high) / 2;
  scene.radius = std::max((high - low).norm() / 2, static_cast<float>(scene.edge) * 1e-6f);
}

}  // namespace

Scene read_scene(const fs::path& folder, const SceneLimits& limits) {
  if (!fs::is_directory(folder))
    throw Error(folder.string() + ": is no folder; that of a lacuna detect is needed");
  Scene scene;
  read_holes(folder / "holes.json", scene);
  read_run(folder / "run.json", scene);
  read_points(folder / "sample.ply", limits.points, scene);
  read_loops(folder / "loops.ply", limits, scene);
  scene.points.spacing = typical_spacing(scene);
  frame(scene);
  return scene;
}

}  // namespace lacuna
