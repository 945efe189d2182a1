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

// By coarse loop, the fine one that it lies on: the first of those with which it shares most points.
std::vector<std::uint32_t> fine_loops_of(const RawLoops& fine, const RawLoops& coarse, const Job& job) {
  std::vector<std::uint32_t> fine_of(coarse.size(), kNoLoop);
  std::vector<std::uint64_t> most(coarse.size());
  SharedPoint before{kNoLoop, kNoLoop};
  std::uint64_t count = 0;
  shared_points(fine, coarse, job).for_each([&](const SharedPoint& shared) {
    count = shared == before ? count + 1 : 1;
    before = shared;
    if (count <= most[shared.coarse]) return;
    most[shared.coarse] = count;
    fine_of[shared.coarse] = shared.fine;
  });
  return fine_of;
}

}  // namespace

void choose_scale(const RawLoops& fine, const RawLoops& coarse, const Job& job, RawLoops& chosen) {
  const std::vector<std::uint32_t> fine_of = fine_loops_of(fine, coarse, job);
  // Of the coarse loops on each: the highest confidence and the sum of lengths.
  std::vector<LoopRating> on(fine.size(), LoopRating{.confidence = 0, .length = 0});
  for (std::uint32_t c = 0; c < coarse.size(); ++c) {
    if (fine_of[c] == kNoLoop) continue;
    LoopRating& of_fine = on[fine_of[c]];
    of_fine.confidence = std::max(of_fine.confidence, coarse.rating(c).confidence);
    of_fine.length += coarse.rating(c).length;
  }
  const double same_hole = job.config.tangential.same_hole;
  const auto stands = [&](std::uint32_t f) {
    const auto& [confidence, length] = fine.rating(f);
    return on[f].length >= same_hole * length || on[f].confidence <= confidence;
  };
  for (std::uint32_t f = 0; f < fine.size(); ++f) {
    if (stands(f)) chosen.add(fine, f);
  }
  for (std::uint32_t c = 0; c < coarse.size(); ++c) {
    if (fine_of[c] == kNoLoop || !stands(fine_of[c])) chosen.add(coarse, c);
  }
}

}  // namespace lacuna::tangential
