#include "engine/boundary/tangential/curves.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <optional>
#include <tuple>

namespace lacuna {
namespace {

// Points without room that are added to a rim, by its unevenness, and at most: shares of a few points say
// little where points have room by chance.
constexpr double kDoubt = 42, kMostDoubt = 6;

// The wedge at `point` that ends at `neighbour`. There is exactly one. `wedges`: in ascending row.
std::size_t wedge_at(std::span<const Gap> wedges, Row point, Row neighbour) {
  const auto first = std::partition_point(wedges.begin(), wedges.end(),
                                          [&](const Gap& wedge) { return wedge.point.row < point; });
  const auto found = std::find_if(
      first, wedges.end(), [&](const Gap& wedge) { return wedge.from == neighbour || wedge.to == neighbour; });
  assert(found != wedges.end() && found->point.row == point);
  return static_cast<std::size_t>(found - wedges.begin());
}

// Place i of the rim as it is read from `start` on, in either direction.
std::size_t place(std::size_t start, std::size_t i, bool forwards, std::size_t count) {
  return forwards ? (start + i) % count : (start + count - i) % count;
}

}  // namespace

void follow_curves(std::vector<Gap> wedges, const std::function<void(std::vector<RimPoint>&)>& visit) {
  std::sort(wedges.begin(), wedges.end(), [](const Gap& a, const Gap& b) {
    return std::tie(a.point.row, a.from, a.to) < std::tie(b.point.row, b.from, b.to);
  });
  std::vector<bool> is_done(wedges.size());
  std::vector<RimPoint> curve;
  for (std::size_t start = 0; start < wedges.size(); ++start) {
    if (is_done[start]) continue;
    curve.clear();
    Row came_from = wedges[start].from;
    for (std::size_t at = start; !is_done[at];) {
      is_done[at] = true;
      const Gap& wedge = wedges[at];
      curve.push_back({wedge.point, wedge.room, wedge.unevenness});
      const Row next = wedge.from == came_from ? wedge.to : wedge.from;
      came_from = wedge.point.row;
      at = wedge_at(wedges, next, came_from);
    }
    visit(curve);
  }
}

void normalise(std::vector<RimPoint>& rim) {
  struct Way {
    std::size_t start;
    bool forwards;
  };
  const std::size_t count = rim.size();
  const auto id = [&](const Way& way, std::size_t i) {
    return rim[place(way.start, i, way.forwards, count)].vertex.id;
  };
  const auto comes_first = [&](const Way& a, const Way& b) {
    for (std::size_t i = 0; i < count; ++i) {
      if (id(a, i) != id(b, i)) return id(a, i) < id(b, i);
    }
    return false;
  };
  PointId least = rim.front().vertex.id;
  for (const RimPoint& p : rim) least = std::min(least, p.vertex.id);
  std::optional<Way> best;
  for (std::size_t start = 0; start < count; ++start) {
    if (rim[start].vertex.id != least) continue;
    for (const bool forwards : {true, false}) {
      const Way way{start, forwards};
      if (!best || comes_first(way, *best)) best = way;
    }
  }
  std::vector<RimPoint> turned;
  turned.reserve(count);
  for (std::size_t i = 0; i < count; ++i) turned.push_back(rim[place(best->start, i, best->forwards, count)]);
  rim = std::move(turned);
}

std::vector<std::vector<RimPoint>> split_at_pinches(std::vector<RimPoint> rim) {
  std::vector<Row> rows;  // then: those that are passed again
  for (const RimPoint& p : rim) rows.push_back(p.vertex.row);
  std::sort(rows.begin(), rows.end());
  std::size_t count = 0;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    if (rows[i] == rows[i + 1] && (count == 0 || rows[count - 1] != rows[i])) rows[count++] = rows[i];
  }
  rows.resize(count);
  std::vector<std::vector<RimPoint>> curves;
  if (rows.empty()) {
    curves.push_back(std::move(rim));
    return curves;
  }
  constexpr std::size_t kNone = SIZE_MAX;
  std::vector<std::size_t> places(rows.size(), kNone);  // on the way
  const auto place_of = [&](const RimPoint& p) -> std::size_t* {
    const auto at = std::lower_bound(rows.begin(), rows.end(), p.vertex.row);
    return at != rows.end() && *at == p.vertex.row ? &places[static_cast<std::size_t>(at - rows.begin())]
                                                   : nullptr;
  };
  std::vector<RimPoint> way;
  for (const RimPoint& p : rim) {
    std::size_t* const place = place_of(p);
    if (place != nullptr && *place != kNone) {
      const auto back = way.begin() + static_cast<std::ptrdiff_t>(*place);
      curves.emplace_back(back, way.end());
      for (const RimPoint& left : curves.back()) {
        if (std::size_t* const of_left = place_of(left); of_left != nullptr) *of_left = kNone;
      }
      way.erase(back, way.end());
    }
    if (place != nullptr) *place = way.size();
    way.push_back(p);
  }
  curves.push_back(std::move(way));
  for (std::vector<RimPoint>& curve : curves) normalise(curve);
  return curves;
}

double confidence(std::span<const RimPoint> rim) {
  const auto points = static_cast<double>(rim.size());
  double unevenness = 0;
  for (const RimPoint& p : rim) unevenness += p.unevenness;
  const double doubt = std::min(kDoubt * (unevenness / points), kMostDoubt);
  const auto share = [&](float room) {
    const auto wide =
        std::count_if(rim.begin(), rim.end(), [&](const RimPoint& p) { return p.room >= room; });
    return static_cast<double>(wide) / (points + doubt);
  };
  return std::min(share(1.5f), std::min(1.25 * share(2.5f), 1.0));
}

}  // namespace lacuna
