// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/scan_truth.hpp"

#include "bench/synth/density_steps.hpp"
#include "bench/synth/ring.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <unordered_set>
#include <utility>

namespace lacuna::synth {

namespace {

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

double distance(Vec3 a, Vec3 b) {
  return std::sqrt(dot(b - a, b - a));
}

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

void to_canonical(std::vector<std::uint64_t>& ids) {
  std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
  if (ids.back() < ids[1]) std::reverse(ids.begin() + 1, ids.end());
}

}  // namespace

ScanTruth::ScanTruth(const Scanner& scanner, std::uint64_t points) : index_({}) {
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

// There is one sphere per place. Places are a step apart at most, but for long ways. A step is not closed.
void ScanTruth::add(const Curve& curve, double least_step, Kind kind, std::string name,
                    std::vector<Sphere>& spheres) {
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

void ScanTruth::note(const Echo& echo, std::uint64_t ray, std::uint64_t id) {
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

// Returns the points nearest to the places of a row in turn. A point that repeats the one before is left out.
// Returns none if points are rare.
std::vector<std::uint64_t> ScanTruth::ids_along(const Row& row) const {
  std::vector<std::uint64_t> ids;
  std::size_t present = 0;
  for (const NearestEcho& place : std::span(places_).subspan(row.begin, row.end - row.begin)) {
    if (place.id == kNobody) continue;
    ++present;
    if (ids.empty() || ids.back() != place.id) ids.push_back(place.id);
  }
  if (static_cast<double>(present) < kSharePresent * static_cast<double>(row.end - row.begin)) return {};
  return ids;
}

std::vector<NamedLoop> ScanTruth::closed_rows(Kind kind) const {
  std::vector<NamedLoop> all;
  for (const Row& row : rows_) {
    if (row.kind != kind) continue;
    std::vector<std::uint64_t> ids = ids_along(row);
    if (ids.size() > 1 && ids.back() == ids.front()) ids.pop_back();
    ids = without_returns(std::move(ids));
    if (ids.size() < kFewestPoints) continue;
    to_canonical(ids);
    all.push_back({std::move(ids), row.name});
  }
  std::sort(all.begin(), all.end(), [](const NamedLoop& a, const NamedLoop& b) { return a.ids < b.ids; });
  return all;
}

std::vector<NamedLoop> ScanTruth::loops() const {
  return closed_rows(Kind::kLoop);
}

// Curves of large holes are curves of all holes, too: a narrow hole has few points of them.
std::vector<std::vector<std::uint64_t>> ScanTruth::narrow_loops() const {
  std::unordered_set<std::uint64_t> on_loops;
  for (const NamedLoop& loop : loops()) on_loops.insert(loop.ids.begin(), loop.ids.end());
  std::vector<std::vector<std::uint64_t>> all;
  for (NamedLoop& loop : closed_rows(Kind::kNarrow)) {
    const auto shared = std::count_if(loop.ids.begin(), loop.ids.end(),
                                      [&](std::uint64_t id) { return on_loops.contains(id); });
    if (2 * static_cast<std::size_t>(shared) < loop.ids.size()) all.push_back(std::move(loop.ids));
  }
  return all;
}

std::vector<std::vector<std::uint64_t>> ScanTruth::steps() const {
  std::vector<std::vector<std::uint64_t>> all;
  for (const Row& row : rows_) {
    if (row.kind != Kind::kStep) continue;
    std::vector<std::uint64_t> ids = ids_along(row);
    if (ids.size() >= kFewestPoints) all.push_back(std::move(ids));
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace lacuna::synth
