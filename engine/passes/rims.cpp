#include "engine/passes/rims.hpp"

#include "engine/core/merge_runs.hpp"
#include "engine/passes/seams.hpp"
#include "engine/stages/rims.hpp"

#include <algorithm>
#include <cassert>
#include <mutex>
#include <tuple>

namespace lacuna {
namespace {

// Parts of rims, on disk; in memory only where each one is and what its ends lead to.
class OpenRims {
 public:
  explicit OpenRims(std::filesystem::path file) : points_(std::move(file)) {}

  void add(const RimPart& part) {
    const std::uint64_t offset = points_.append(part.points);
    const std::lock_guard lock(mutex_);
    parts_.push_back({offset, part.points.size()});
    const auto index = static_cast<std::uint32_t>(parts_.size() - 1);
    ends_.push_back(end_of(part.before, part.points.front().vertex.row, index, 0));
    ends_.push_back(end_of(part.after, part.points.back().vertex.row, index, 1));
  }

  using Side = std::uint32_t;  // 2 * part, + 1: its end

  // Of each rim the sides at which its parts are entered, in their order.
  std::vector<std::vector<Side>> join() {
    const std::vector<Side> partners = find_partners();
    std::vector<bool> is_done(parts_.size());
    std::vector<std::vector<Side>> rims;
    for (std::uint32_t start = 0; start < parts_.size(); ++start) {
      if (is_done[start]) continue;
      std::vector<Side>& entries = rims.emplace_back();
      Side enter = 2 * start;
      do {
        entries.push_back(enter);
        is_done[enter / 2] = true;
        enter = partners[enter ^ 1];
        assert(enter != kNone);  // rims are closed
      } while (!is_done[enter / 2]);
      assert(enter == entries.front());
    }
    return rims;
  }

  std::vector<RimPoint> read(std::span<const Side> entries) const {
    std::vector<RimPoint> rim;
    for (const Side entry : entries) {
      const Part& part = parts_[entry / 2];
      std::vector<RimPoint> points = points_.read(part.offset, part.count);
      if (entry % 2 == 1) std::reverse(points.begin(), points.end());
      rim.insert(rim.end(), points.begin(), points.end());
    }
    return rim;
  }

 private:
  struct Part {
    std::uint64_t offset, count;
  };
  // An edge between tiles.
  struct End {
    Row low, high;
    Side side;

    friend bool operator<(const End& a, const End& b) {
      return std::tie(a.low, a.high, a.side) < std::tie(b.low, b.high, b.side);
    }
  };
  static constexpr Side kNone = UINT32_MAX;

  static End end_of(Row a, Row b, std::uint32_t part, Side side) {
    return {std::min(a, b), std::max(a, b), 2 * part + side};
  }

  // Of each side that of the other part at the same edge.
  std::vector<Side> find_partners() {
    std::sort(ends_.begin(), ends_.end());
    std::vector<Side> partners(2 * parts_.size(), kNone);
    for (std::size_t i = 0; i + 1 < ends_.size(); ++i) {
      const End &a = ends_[i], &b = ends_[i + 1];
      if (a.low != b.low || a.high != b.high) continue;
      partners[a.side] = b.side;
      partners[b.side] = a.side;
    }
    return partners;
  }

  GrowingColumn<RimPoint> points_;
  std::vector<Part> parts_;
  std::vector<End> ends_;
  std::mutex mutex_;
};

void report(std::vector<RimPoint> rim, const TangentialConfig& config, RawLoops& loops) {
  const auto least = static_cast<std::size_t>(config.min_curve);
  if (rim.size() < least) return;
  normalise(rim);
  for (const std::vector<RimPoint>& curve : split_at_pinches(std::move(rim))) {
    if (curve.size() < least) continue;
    std::vector<Vertex> loop;
    loop.reserve(curve.size());
    for (const RimPoint& p : curve) loop.push_back(p.vertex);
    loops.add(loop, confidence(curve, config));
  }
}

// The whole rims of a tile to `loops`, the parts of others to `open`.
void follow_tile(StarLists& lists, const Tiling& tiling, std::size_t t, const TangentialConfig& config,
                 RawLoops& loops, OpenRims& open) {
  const Row first = tiling.tiles[t].first_row, last{value(first) + tiling.tiles[t].points};
  std::vector<Gap> gaps = lists.gaps.read(t);
  lists.gaps.drop(t);
  const std::vector<Gap> open_gaps = lists.open_gaps.read(t);
  lists.open_gaps.drop(t);
  gaps.insert(gaps.end(), open_gaps.begin(), open_gaps.end());
  merge_runs(gaps, [](const Gap& a, const Gap& b) { return a.point.row < b.point.row; });
  follow_rims(gaps, first, last, [&](RimPart& part) {
    if (part.is_closed) {
      report(std::move(part.points), config, loops);
    } else {
      open.add(part);
    }
  });
}

}  // namespace

RawLoops trace_rims(StarLists& lists, const Tiling& tiling, Job& job) {
  Phase phase(job, "loops", 0);
  settle_seams(lists, tiling, job);
  RawLoops loops(job.file("raw-loops"), job.config.selection.min_confidence);
  OpenRims open(job.file("open-rims"));
  const TangentialConfig& config = job.config.tangential;
  job.crew.for_each(tiling.tiles.size(),
                    [&](std::size_t t) { follow_tile(lists, tiling, t, config, loops, open); });
  const auto rims = open.join();
  job.crew.for_each(rims.size(), [&](std::size_t i) { report(open.read(rims[i]), config, loops); });
  loops.sort();
  return loops;
}

}  // namespace lacuna
