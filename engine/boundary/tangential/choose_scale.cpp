#include "engine/boundary/tangential/choose_scale.hpp"

#include "engine/model/ids.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

namespace lacuna::tangential {
namespace {

constexpr std::uint32_t kNoLoop = UINT32_MAX;

struct PointOfLoop {
  Row row;
  std::uint32_t loop;
  std::uint32_t is_coarse;

  friend bool operator<(const PointOfLoop& a, const PointOfLoop& b) {
    return std::tie(a.row, a.is_coarse, a.loop) < std::tie(b.row, b.is_coarse, b.loop);
  }
};

// A point that a coarse and a fine loop share.
struct SharedPoint {
  std::uint32_t coarse, fine;

  friend bool operator<(const SharedPoint& a, const SharedPoint& b) {
    return std::tie(a.coarse, a.fine) < std::tie(b.coarse, b.fine);
  }
  friend bool operator==(const SharedPoint&, const SharedPoint&) = default;
};

void add_points(const RawLoops& loops, bool is_coarse, SortedRuns<PointOfLoop>& points) {
  for (std::uint32_t i = 0; i < loops.size(); ++i)
    loops.for_each_vertex(i, [&](const Vertex& v) { points.add({v.row, i, is_coarse}); });
}

SortedRuns<SharedPoint> shared_points(const RawLoops& fine, const RawLoops& coarse, const Job& job) {
  SortedRuns<PointOfLoop> points(job.file("points-of-loops"), job.memory.global / 8);
  add_points(fine, false, points);
  add_points(coarse, true, points);
  SortedRuns<SharedPoint> shared(job.file("shared-points"), job.memory.global / 8);
  std::vector<std::uint32_t> fine_here;  // loops that pass through the row
  Row row{};
  points.for_each([&](const PointOfLoop& p) {
    if (p.row != row) fine_here.clear();
    row = p.row;
    if (p.is_coarse == 0) {
      fine_here.push_back(p.loop);
    } else {
      for (const std::uint32_t f : fine_here) shared.add({p.loop, f});
    }
  });
  return shared;
}

// Each coarse loop with each fine one that it lies on: one that has at least a quarter of its points.
std::vector<SharedPoint> same_places(const RawLoops& fine, const RawLoops& coarse, const Job& job) {
  std::vector<SharedPoint> places;
  SharedPoint before{kNoLoop, kNoLoop};
  std::uint64_t count = 0;
  shared_points(fine, coarse, job).for_each([&](const SharedPoint& shared) {
    count = shared == before ? count + 1 : 1;
    before = shared;
    if (count == (coarse.points(shared.coarse) + 3) / 4) places.push_back(shared);
  });
  return places;
}

}  // namespace

void choose_scale(const RawLoops& fine, const RawLoops& coarse, const Job& job, RawLoops& chosen) {
  const std::vector<SharedPoint> places = same_places(fine, coarse, job);
  // For each fine loop: the highest confidence of the coarse loops on it, and the length of the sure ones.
  std::vector<LoopRating> on(fine.size(), LoopRating{.confidence = 0, .length = 0});
  for (const auto& [c, f] : places) {
    const auto& [confidence, length] = coarse.rating(c);
    on[f].confidence = std::max(on[f].confidence, confidence);
    if (confidence >= kSure) on[f].length += length;
  }
  const double same_hole = job.config.tangential.same_hole;
  const auto stands = [&](std::uint32_t f) {
    const auto& [confidence, length] = fine.rating(f);
    return on[f].confidence <= confidence || (confidence >= kSure && on[f].length >= same_hole * length);
  };
  std::vector<std::uint8_t> is_covered(coarse.size());
  for (const auto& [c, f] : places) is_covered[c] |= stands(f);
  const double least = job.config.selection.min_confidence;
  for (std::uint32_t f = 0; f < fine.size(); ++f) {
    if (stands(f) && fine.rating(f).confidence >= least) chosen.add(fine, f);
  }
  for (std::uint32_t c = 0; c < coarse.size(); ++c) {
    if (!is_covered[c] && coarse.rating(c).confidence >= least) chosen.add(coarse, c);
  }
}

}  // namespace lacuna::tangential
