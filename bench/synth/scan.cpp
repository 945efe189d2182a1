// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/scan.hpp"

#include "bench/synth/curves.hpp"
#include "bench/synth/scanner.hpp"
#include "engine/run/error.hpp"
#include "io/read/files/number.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace lacuna::synth {

using namespace io;
using evaluation::NamedLoopIds, evaluation::TrueRows;

namespace {

// ---- The true loops

constexpr double kHoleRadius = 2;    // spacings: narrower gaps do not count
constexpr double kNarrowRadius = 1;  // still narrower ones are no holes
constexpr double kPlaceStep = 0.25;  // spacings between places on a curve
constexpr double kMostPlaces = 1e6;
constexpr double kSearchRadius = 4;        // spacings: the coarse direction of grazing rays included
constexpr double kSharePresent = 0.5;      // of the places must have a point
constexpr std::size_t kFewestPoints = 12;  // around a hole four spacings across
constexpr double kShareCaused = 0.8;       // of the curve must be where a station loses the surface
constexpr double kShareNamed = 0.2;        // of that is what a cause needs to be named
constexpr std::uint64_t kNobody = std::numeric_limits<std::uint64_t>::max();

template <typename Use>
void for_each_side(const Curve& curve, const Use& use) {
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const CurveNode& from = curve[i];
    const CurveNode& to = curve[i + 1 < curve.size() ? i + 1 : 0];
    use(from, to, distance(from.position, to.position));
  }
}

// Returns the causes of a fifth of the curve or more, the largest share first; edges only if there is no
// other cause. Things of one name are named once. Empty if a fifth of the curve runs through gaps that are
// too narrow for a hole.
std::string name_of(const Curve& curve, const Scene& scene) {
  std::map<std::string, double> edges, others;
  double whole = 0, caused = 0;
  for_each_side(curve, [&](const CurveNode& from, const CurveNode&, double length) {
    if (from.long_way) return;
    whole += length;
    if (from.cause.kind == Cause::kNone) return;
    caused += length;
    (from.cause.kind == Cause::kEdge ? edges : others)[in_words(from.cause, scene)] += length;
  });
  if (caused < kShareCaused * whole) return {};
  const auto list = [&](const std::map<std::string, double>& causes) {
    std::vector<std::pair<double, std::string>> sorted;
    for (const auto& [words, length] : causes)
      if (length >= kShareNamed * caused) sorted.emplace_back(-length, words);
    std::sort(sorted.begin(), sorted.end());
    std::string text;
    for (const auto& [length, words] : sorted) text += (text.empty() ? "" : ", ") + words;
    return text;
  };
  const std::string text = list(others);
  return text.empty() ? list(edges) : text;
}

// A true loop is the sequence of points that are nearest to a place on a boundary curve, as the place goes
// around. Only points on the surface of the place count. They count where they would lie without noise,
// strays and errors of registration, so these errors change nothing. The curves are the edges of the
// surface's holes and its outer edges. Steps of density (density_steps()) become sequences of points in the
// same way.
class ScanTruth {
 public:
  ScanTruth(const Scanner& scanner, std::uint64_t points) : index_({}) {
    const Visibility visibility(scanner);
    std::vector<Lattice> lattices = sample_surfaces(scanner, visibility, points);
    std::vector<Lattice> narrow = lattices;
    close_gaps(lattices, visibility, kHoleRadius);
    close_gaps(narrow, visibility, kNarrowRadius);
    const std::vector<Curve> curves = boundary_curves(lattices, visibility);
    double whole = 0;
    for (const Curve& curve : curves)
      for_each_side(curve, [&](const CurveNode&, const CurveNode&, double length) { whole += length; });
    std::vector<Sphere> spheres;
    const auto add_closed = [&](const std::vector<Curve>& closed, Kind kind) {
      for (const Curve& curve : closed) {
        std::string name = name_of(curve, scanner.scene());
        if (!name.empty()) add(curve, whole / kMostPlaces, kind, std::move(name), spheres);
      }
    };
    add_closed(curves, Kind::kLoop);
    add_closed(boundary_curves(narrow, visibility), Kind::kNarrow);
    for (const Curve& step : density_steps(lattices, scanner, visibility))
      add(step, whole / kMostPlaces, Kind::kStep, {}, spheres);
    index_ = SphereIndex(std::move(spheres));
  }

  // Records that the echo of this ray was written as the `id`-th point.
  void note(const Echo& echo, std::uint64_t ray, std::uint64_t id) {
    if (echo.stray) return;
    index_.for_each_around(echo.place, [&](std::uint32_t number) {
      NearestEcho& place = places_[number];
      if (place.shape != echo.shape) return;
      const Vec3 arm = echo.place - index_.spheres()[number].centre;
      const double squared = dot(arm, arm);
      if (squared > place.nearest || (squared == place.nearest && ray > place.ray)) return;
      place = {place.shape, squared, ray, id};
    });
  }

  // Call it after every echo is recorded. Returns each loop in canonical form, sorted, and its name, such as
  // "window". Loops with fewer than 12 points are left out. So are loops where points are rare, and loops
  // with much of their edge in closed gaps. Narrow loops are at least half as wide as the narrowest ones that
  // count.
  //
  // A step has 12 points or more, and steps are sorted. Where a sequence is closed, its first point is its
  // last, too.
  TrueRows rows() const {
    TrueRows rows{.loops = closed_rows(Kind::kLoop)};
    std::unordered_set<std::uint64_t> on_loops;
    for (const NamedLoopIds& loop : rows.loops) on_loops.insert(loop.ids.begin(), loop.ids.end());
    // Curves of large holes are curves of all holes, too: a narrow hole has few points of them.
    for (NamedLoopIds& loop : closed_rows(Kind::kNarrow)) {
      const auto shared =
          std::ranges::count_if(loop.ids, [&](std::uint64_t id) { return on_loops.contains(id); });
      if (2 * static_cast<std::size_t>(shared) < loop.ids.size()) rows.loops.push_back(std::move(loop));
    }
    for (const Row& row : rows_) {
      if (row.kind != Kind::kStep) continue;
      NumberLoop ids = ids_along(row);
      if (ids.size() >= kFewestPoints) rows.steps.push_back(std::move(ids));
    }
    std::ranges::sort(rows.steps);
    return rows;
  }

 private:
  struct NearestEcho {
    std::uint32_t shape;
    double nearest;  // squared
    std::uint64_t ray, id;
  };
  enum class Kind : std::uint8_t { kLoop, kNarrow, kStep };
  struct Row {
    std::size_t begin, end;  // places
    Kind kind;
    std::string name;  // of a loop
  };

  // There is one sphere per place. Places are a step apart at most, but for long ways. A step is not closed.
  void add(const Curve& curve, double least_step, Kind kind, std::string name, std::vector<Sphere>& spheres) {
    const std::size_t begin = places_.size();
    const auto add_place = [&](Vec3 position, const CurveNode& near) {
      spheres.push_back({position, kSearchRadius * near.spacing});
      places_.push_back({near.shape, std::numeric_limits<double>::infinity(), kNobody, kNobody});
    };
    std::size_t sides = kind == Kind::kStep ? curve.size() - 1 : curve.size();
    for_each_side(curve, [&](const CurveNode& from, const CurveNode& to, double length) {
      if (sides == 0) return add_place(from.position, from);
      --sides;
      const double step = std::max(kPlaceStep * std::min(from.spacing, to.spacing), least_step);
      const double steps = from.long_way ? 1 : std::max(std::ceil(length / step), 1.0);
      for (double i = 0; i < steps; ++i) {
        const double share = i / steps;
        add_place(from.position + share * (to.position - from.position), share < 0.5 ? from : to);
      }
    });
    rows_.push_back({begin, places_.size(), kind, std::move(name)});
  }

  // Returns the points nearest to the places of a row in turn. A point that repeats the one before is left
  // out. Returns none if points are rare.
  NumberLoop ids_along(const Row& row) const {
    NumberLoop ids;
    std::size_t present = 0;
    for (const NearestEcho& place : std::span(places_).subspan(row.begin, row.end - row.begin)) {
      if (place.id == kNobody) continue;
      ++present;
      if (ids.empty() || ids.back() != place.id) ids.push_back(place.id);
    }
    if (static_cast<double>(present) < kSharePresent * static_cast<double>(row.end - row.begin)) return {};
    return ids;
  }

  std::vector<NamedLoopIds> closed_rows(Kind kind) const {
    std::vector<NamedLoopIds> all;
    for (const Row& row : rows_) {
      if (row.kind != kind) continue;
      NumberLoop ids = ids_along(row);
      if (ids.size() > 1 && ids.back() == ids.front()) ids.pop_back();
      ids = without_returns(std::move(ids));
      if (ids.size() < kFewestPoints) continue;
      to_canonical(ids);
      all.push_back({std::move(ids), row.name, kind == Kind::kNarrow});
    }
    std::ranges::sort(all, {}, &NamedLoopIds::ids);
    return all;
  }

  std::vector<NearestEcho> places_;
  std::vector<Row> rows_;
  SphereIndex index_;
};

// ---- The files

void check(const ScanOptions& o) {
  require(o.points >= 1 && o.points <= 1'000'000'000'000, "--points: must be 1 to 1e12");
  require(o.stations >= 1 && o.stations <= 255, "--stations: must be 1 to 255");
  require(o.noise >= 0 && o.noise <= 10, "--noise: must be 0 to 10 metres");
  require(o.outliers >= 0 && o.outliers <= 1, "--outliers: must be 0 to 1");
  require(o.registration >= 0 && o.registration <= 1, "--registration: must be 0 to 1 metre");
  require(o.max_range >= 1 && o.max_range <= 1e6, "--max-range: must be 1 to 1e6 metres");
  require(o.ring_ratio >= 0.01 && o.ring_ratio <= 100, "--ring-ratio: must be 0.01 to 100");
  require(
      o.field_of_view[0] >= -90 && o.field_of_view[0] + 1 <= o.field_of_view[1] && o.field_of_view[1] <= 90,
      "--field-of-view: needs -90 <= lowest < highest <= 90 degrees, 1 degree apart");
  require(o.station_factor >= 0.01 && o.station_factor <= 100, "--station-factor: must be 0.01 to 100");
  require(o.sweeps >= 1 && o.sweeps <= 8, "--sweeps: must be 1 to 8");
  for (const double offset : o.translate) {
    require(std::fabs(offset) <= 1e12, "--translate: must be within 1e12 metres");
    require(o.coordinates == Coordinates::kDouble || std::fabs(offset) <= 10'000,
            "--translate: floats are too coarse that far out; add --double");
  }
}

constexpr std::string_view kStationsMark = "# stations of a synthetic scan: name x y z source\n";

constexpr std::string_view kTrajectoryMark = "# trajectory of a synthetic scan\ntime x y z\n";

void append_place(std::string& line, Vec3 place, const ScanOptions& options) {
  const auto [x, y, z] = options.translate;
  for (const double coordinate : {place.x + x, place.y + y, place.z + z}) {
    line += ' ';
    append_shortest(line, coordinate);
  }
}

// Writes places as `--stations` of lacuna detect reads them.
void write_stations(const Scanner& scanner, const ScanOptions& options, OutputFile& file) {
  file.write(kStationsMark);
  for (std::size_t i = 0; i < scanner.stations().size(); ++i) {
    std::string line = "station_" + std::to_string(i);
    append_place(line, scanner.stations()[i], options);
    file.write(line + " " + std::to_string(i) + "\n");
  }
}

// Each strip has a place for every metre.
void write_trajectory(const Scanner& scanner, const ScanOptions& options, OutputFile& file) {
  file.write(kTrajectoryMark);
  const double length = scanner.strip_length();
  const double steps = std::ceil(std::min(length, 1000.0));
  for (const Sweep& strip : scanner.sweeps()) {
    for (double step = 0; step <= steps; ++step) {
      const double share = step / steps;
      std::string line;
      append_shortest(line, scanner.strip_start(strip.station) + share * length / Scanner::kSpeed);
      append_place(line, strip.origin + (share - 0.5) * length * strip.x, options);
      file.write(line + "\n");
    }
  }
}

}  // namespace

Made write_scan(const ScanOptions& options) {
  return write_scan(options, make_scene(options.scene, options.seed));
}

Made write_scan(const ScanOptions& options, const Scene& scene) {
  check(options);
  if (scene.flown || options.drives) {
    require(options.sweeps == 1, "--sweeps: a moving scanner has one sweep on each strip");
    require(options.field_of_view == kFieldOfView, "--field-of-view: a moving scanner has its own");
  }
  const std::filesystem::path truth_path = truth_file_of(options.out, options.truth);
  const Scanner scanner(options, scene);
  NewFile truth_output(truth_path, kTruthMark, options.overwrite);
  OutputFile& truth_file = truth_output.content();
  NewFile stations_output(std::filesystem::path(options.out)
                              .replace_extension(scanner.moves() ? ".trajectory.txt" : ".stations.txt"),
                          scanner.moves() ? kTrajectoryMark : kStationsMark, options.overwrite);
  OutputFile& stations = stations_output.content();
  NewFile scan(options.out, kScanMark, options.overwrite);
  PlyOutput ply(scan.content(), options.coordinates, scanner.moves() ? Extras::kScanAndTime : Extras::kScan);
  const std::uint64_t count = scanner.rays();
  ScanTruth truth(scanner, options.points);
  const Permutation shuffled(count, options.seed);

  for (std::uint64_t turn = 0; turn < count; ++turn) {
    const std::uint64_t index = options.order == Order::kRandom ? shuffled(turn) : turn;
    const Ray ray = scanner.ray(index);
    const std::optional<Echo> echo = scanner.measure(ray, index);
    if (!echo) continue;
    truth.note(*echo, index, ply.count());
    ply.add(echo->position, static_cast<std::uint8_t>(scanner.sweeps()[ray.sweep].station),
            static_cast<float>(echo->intensity), scanner.moves() ? scanner.time(ray) : 0);
  }

  const TrueRows rows = truth.rows();
  write_truth(truth_file, options.out, rows);
  scanner.moves() ? write_trajectory(scanner, options, stations) : write_stations(scanner, options, stations);
  ply.finish();
  truth_output.commit();
  stations_output.commit();
  scan.commit();
  const auto loops = std::ranges::count(rows.loops, false, &NamedLoopIds::is_narrow);
  return {
      .points = ply.count(), .loops = static_cast<std::uint64_t>(loops), .truth = truth_path, .rays = count};
}

}  // namespace lacuna::synth
