#include "engine/passes/rims.hpp"

#include "engine/stages/rims.hpp"
#include "engine/stages/stars.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <tuple>

namespace lacuna {
namespace {

// The star of `from` has the triangle (from, to, other); told to the tile of `to`.
struct Claim {
  LocalIndex to;
  std::uint32_t padding = 0;
  Row from, other;

  friend bool operator<(const Claim& a, const Claim& b) {
    return std::tie(a.to, a.from, a.other) < std::tie(b.to, b.from, b.other);
  }
};

// One tile's rows.
class Here {
 public:
  Here(const Tiling& tiling, TileIndex tile)
      : first_(value(tiling.tiles[tile].first_row)), points_(tiling.tiles[tile].points) {}

  bool owns(const Vertex& v) const { return value(v.row) - first_ < points_; }
  LocalIndex local(const Vertex& v) const { return static_cast<LocalIndex>(value(v.row) - first_); }
  Row row(LocalIndex owned) const { return Row{first_ + owned}; }
  Row first() const { return Row{first_}; }
  Row last() const { return Row{first_ + points_}; }

 private:
  std::uint64_t first_, points_;
};

// ---- stars of points with neighbours in other tiles

// Claims on their way, gathered by the tile that they are for.
class Letters {
 public:
  explicit Letters(const Tiling& tiling) : tiling_(tiling) {}

  // Tells the tiles of a star's foreign corners of the triangles that it has with them.
  void tell(const Vertex& point, std::span<const StoredCorner> star, const Here& here) {
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (star[i].room > 1) continue;
      const Vertex &a = star[i].corner, &b = star[i + 1 < star.size() ? i + 1 : 0].corner;
      if (!here.owns(a)) tell_one(point, a, b);
      if (!here.owns(b)) tell_one(point, b, a);
    }
  }

  void send(Spill<Claim>& claims) const {
    for (const auto& [tile, letter] : letters_) claims.append(tile, letter);
  }

 private:
  void tell_one(const Vertex& point, const Vertex& to, const Vertex& other) {
    const TileIndex tile = tiling_.tile_of_row(to.row);
    letters_[tile].push_back({Here(tiling_, tile).local(to), 0, point.row, other.row});
  }

  const Tiling& tiling_;
  std::map<TileIndex, std::vector<Claim>> letters_;
};

void find_border_stars(EvaluatedScan& scan, const Tiling& tiling, TileIndex t, Spill<Claim>& claims) {
  const Here here(tiling, t);
  const std::vector<BorderPoint> border = scan.border.read(t);
  const std::vector<LocalIndex> neighbours = scan.border_neighbours.read(t);
  const std::vector<Vertex> in_sight = scan.border_sight.read(t);
  scan.border.drop(t);
  scan.border_neighbours.drop(t);
  scan.border_sight.drop(t);
  std::vector<Seat> seats;
  RunReader<Seat> reader(scan.seats);
  for (const Vertex& v : in_sight) seats.push_back(reader[value(v.row)]);

  StarFinder finder(seats);
  std::vector<StarQuery> queries;
  std::vector<StoredCorner> stars;
  Letters letters(tiling);
  std::span<const LocalIndex> left = neighbours;
  for (std::size_t first = 0; first < border.size(); first += kStarBundle) {
    const auto bundle = std::span(border).subspan(first, std::min(kStarBundle, border.size() - first));
    queries.clear();
    for (const BorderPoint& p : bundle) {
      queries.push_back({p.place, {p.normal[0], p.normal[1], p.normal[2]}, left.first(p.neighbours)});
      left = left.subspan(p.neighbours);
    }
    finder.find(queries);
    for (std::size_t i = 0; i < bundle.size(); ++i) {
      const BorderPoint& p = bundle[i];
      const Vertex& point = in_sight[p.place];
      const std::size_t begin = stars.size();
      for (std::size_t c = 0; c < finder[i].size(); ++c) {
        const StarCorner<LocalIndex>& corner = finder[i][c];
        stars.push_back({point.id, p.owned, corner.room > 1 ? Agreement::kRefused : Agreement::kOpen,
                         in_sight[queries[i].neighbours[corner.point]], corner.room});
      }
      letters.tell(point, std::span(stars).subspan(begin), here);
    }
  }
  scan.stars.append(t, stars);
  letters.send(claims);
}

// ---- what all corners agree on

// The stars of a tile that were not settled when it was evaluated.
class OpenStars {
 public:
  OpenStars(const Here& here, std::vector<StoredCorner> corners) {
    std::stable_sort(corners.begin(), corners.end(),
                     [](const auto& a, const auto& b) { return a.owned < b.owned; });
    for (const StoredCorner& c : corners) {
      if (points_.empty() || points_.back() != c.owned) {
        points_.push_back(c.owned);
        vertices_.push_back({c.id, here.row(c.owned)});
        stars_.offsets.push_back(stars_.offsets.back());
      }
      stars_.corners.push_back({c.corner, c.room});
      stars_.agreements.push_back(c.agreement);
      ++stars_.offsets.back();
    }
  }

  std::span<const LocalIndex> points() const { return points_; }
  const Vertex& vertex(std::size_t i) const { return vertices_[i]; }
  std::span<const StarCorner<Vertex>> star(std::size_t i) const { return stars_[i]; }
  std::span<Agreement> agreements(std::size_t i) {
    return std::span(stars_.agreements).subspan(stars_.offsets[i], stars_[i].size());
  }

  // An owned corner has its triangle with a and b, one of the three a border point. If it has, it is here:
  // the triangle could not be settled before.
  bool agrees(LocalIndex corner, const Vertex& a, const Vertex& b) const {
    const auto at = std::lower_bound(points_.begin(), points_.end(), corner);
    return at != points_.end() && *at == corner &&
           has_triangle(stars_[static_cast<std::size_t>(at - points_.begin())], a, b);
  }

 private:
  std::vector<LocalIndex> points_;  // ascending
  std::vector<Vertex> vertices_;    // the same
  Stars<Vertex> stars_;
};

void agree(EvaluatedScan& scan, const TileStore& store, TileIndex t, Spill<Claim>& claims) {
  const Here here(store.tiling(), t);
  OpenStars stars(here, scan.stars.read(t));
  scan.stars.drop(t);
  std::vector<Claim> told = claims.read(t);
  claims.drop(t);
  std::sort(told.begin(), told.end());

  std::vector<Gap<Vertex>> gaps;
  for (std::size_t s = 0; s < stars.points().size(); ++s) {
    const LocalIndex p = stars.points()[s];
    const auto star = stars.star(s);
    const auto agreements = stars.agreements(s);
    const Vertex point = stars.vertex(s);
    const auto agrees = [&](const Vertex& corner, const Vertex& other) {
      if (here.owns(corner)) return stars.agrees(here.local(corner), point, other);
      return std::binary_search(told.begin(), told.end(), Claim{p, 0, corner.row, other.row});
    };
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (agreements[i] != Agreement::kOpen) continue;
      const Vertex &a = star[i].point, &b = star[i + 1 < star.size() ? i + 1 : 0].point;
      agreements[i] = agrees(a, b) && agrees(b, a) ? Agreement::kAgreed : Agreement::kRefused;
    }
    for_each_gap(point, star, std::span<const Agreement>(agreements),
                 [&](const Gap<Vertex>& gap) { gaps.push_back(gap); });
  }
  scan.gaps.append(t, gaps);
}

// ---- rims across tiles

// Parts of rims, on disk; in memory only where each one is and what its ends lead to.
class OpenRims {
 public:
  explicit OpenRims(std::filesystem::path file) : points_(std::move(file)) {}

  void add(const RimPart& part) {
    const std::lock_guard lock(mutex_);
    points_.write(end_, part.points);
    parts_.push_back({end_, part.points.size()});
    const auto index = static_cast<std::uint32_t>(parts_.size() - 1);
    ends_.push_back(end_of(part.before, part.points.front().vertex, index, 0));
    ends_.push_back(end_of(part.after, part.points.back().vertex, index, 1));
    end_ += part.points.size();
  }

  // visit(points): each closed rim.
  template <class Visit>
  void for_each_rim(Visit&& visit) {
    // The two ends of parts that meet at an edge.
    std::sort(ends_.begin(), ends_.end());
    std::vector<Side> partner(2 * parts_.size());
    for (std::size_t i = 0; i + 1 < ends_.size(); i += 2) {
      partner[ends_[i].side] = ends_[i + 1].side;
      partner[ends_[i + 1].side] = ends_[i].side;
    }
    std::vector<bool> is_done(parts_.size());
    for (std::uint32_t start = 0; start < parts_.size(); ++start) {
      if (is_done[start]) continue;
      std::vector<RimPoint> rim;
      Side enter = 2 * start;
      do {
        const std::uint32_t part = enter / 2;
        is_done[part] = true;
        std::vector<RimPoint> points = points_.read(parts_[part].offset, parts_[part].count);
        if (enter % 2 == 1) std::reverse(points.begin(), points.end());
        rim.insert(rim.end(), points.begin(), points.end());
        enter = partner[enter ^ 1];
      } while (enter / 2 != start);
      visit(rim);
    }
  }

 private:
  using Side = std::uint32_t;  // 2 * part, + 1: its end

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
  static End end_of(const Vertex& a, const Vertex& b, std::uint32_t part, Side side) {
    return {std::min(a.row, b.row), std::max(a.row, b.row), 2 * part + side};
  }

  Column<RimPoint> points_;
  std::uint64_t end_ = 0;
  std::vector<Part> parts_;
  std::vector<End> ends_;
  std::mutex mutex_;
};

void report(std::vector<RimPoint>& rim, RawLoops& loops) {
  if (rim.size() < kLeastRim) return;
  normalise(rim);
  std::vector<Vertex> loop;
  loop.reserve(rim.size());
  for (const RimPoint& p : rim) loop.push_back(p.vertex);
  loops.add(loop, confidence(rim));
}

}  // namespace

RawLoops trace_rims(EvaluatedScan& scan, const TileStore& store, Job& job) {
  Phase phase(job, "loops", 0);
  const Tiling& tiling = store.tiling();
  const std::size_t tiles = tiling.tiles.size();
  Spill<Claim> claims(job.file("claims"), tiles, job.memory.spills / 4);
  job.crew.for_each(
      tiles, [&](std::size_t t) { find_border_stars(scan, tiling, static_cast<TileIndex>(t), claims); });
  job.crew.for_each(tiles, [&](std::size_t t) { agree(scan, store, static_cast<TileIndex>(t), claims); });

  RawLoops loops(job.file("raw-loops"));
  OpenRims open(job.file("open-rims"));
  job.crew.for_each(tiles, [&](std::size_t t) {
    const Here here(tiling, static_cast<TileIndex>(t));
    std::vector<Gap<Vertex>> gaps = scan.gaps.read(t);
    scan.gaps.drop(t);
    std::sort(gaps.begin(), gaps.end(), [](const auto& a, const auto& b) {
      return std::tie(a.point.row, a.from.row) < std::tie(b.point.row, b.from.row);
    });
    follow_rims(gaps, here.first(), here.last(),
                [&](RimPart& part) { part.is_closed ? report(part.points, loops) : open.add(part); });
  });
  open.for_each_rim([&](std::vector<RimPoint>& rim) { report(rim, loops); });
  loops.sort();
  return loops;
}

}  // namespace lacuna
