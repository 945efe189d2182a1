#include "engine/boundary/tangential/curves.hpp"

#include "engine/store/row_numbers.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <optional>

namespace lacuna {
namespace {

// Place i of the curve as it is read from `start` on, in either direction.
std::size_t place(std::size_t start, std::size_t i, bool forwards, std::size_t count) {
  return forwards ? (start + i) % count : (start + count - i) % count;
}

}  // namespace

std::vector<WedgePartners> partners_of(std::span<const Wedge> wedges) {
  RowNumbers points;
  points.collect(wedges.size(), [&](auto&& add) {
    for (const Wedge& wedge : wedges) add(wedge.point.row);
  });
  std::vector<LocalIndex> begins(points.size() + 1);  // of each point's wedges
  for (const Wedge& wedge : wedges) ++begins[points.number(wedge.point.row) + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());

  // The wedge at `point` with an edge to `neighbour`: there is at most one.
  const auto find = [&](Row point, Row neighbour) {
    const std::optional<LocalIndex> number = points.find(point);
    if (!number) return kNoIndex;
    for (LocalIndex i = begins[*number]; i < begins[*number + 1]; ++i) {
      if (wedges[i].from == neighbour || wedges[i].to == neighbour) return i;
    }
    return kNoIndex;
  };
  std::vector<WedgePartners> partners;
  partners.reserve(wedges.size());
  for (const Wedge& wedge : wedges)
    partners.push_back({find(wedge.from, wedge.point.row), find(wedge.to, wedge.point.row)});
  return partners;
}

void follow_wedges(std::span<const Wedge> wedges, std::span<const WedgePartners> partners,
                   const std::function<void(const WedgeChain&)>& visit) {
  std::vector<bool> is_done(wedges.size());
  std::vector<LocalIndex> numbers;
  // Leaves the first wedge by the other side.
  const auto follow = [&](LocalIndex start, std::size_t first_side) {
    numbers.clear();
    std::size_t side = 1 - first_side;
    for (LocalIndex at = start;;) {
      is_done[at] = true;
      numbers.push_back(at);
      const LocalIndex next = partners[at][side];
      if (next == kNoIndex || is_done[next]) {
        visit({numbers, next != kNoIndex, first_side, side});
        return;
      }
      side = wedges[next].from == wedges[at].point.row ? 1 : 0;
      at = next;
    }
  };
  for (LocalIndex start = 0; start < wedges.size(); ++start) {
    for (const std::size_t side : {0, 1}) {
      if (!is_done[start] && partners[start][side] == kNoIndex) follow(start, side);
    }
  }
  for (LocalIndex start = 0; start < wedges.size(); ++start) {
    if (!is_done[start]) follow(start, 0);
  }
}

void normalise(std::vector<CurvePoint>& curve) {
  struct Way {
    std::size_t start;
    bool forwards;
  };
  const std::size_t count = curve.size();
  const auto id = [&](const Way& way, std::size_t i) {
    return curve[place(way.start, i, way.forwards, count)].vertex.id;
  };
  const auto comes_first = [&](const Way& a, const Way& b) {
    for (std::size_t i = 0; i < count; ++i) {
      if (id(a, i) != id(b, i)) return id(a, i) < id(b, i);
    }
    return false;
  };
  PointId least = curve.front().vertex.id;
  for (const CurvePoint& p : curve) least = std::min(least, p.vertex.id);
  std::optional<Way> best;
  for (std::size_t start = 0; start < count; ++start) {
    if (curve[start].vertex.id != least) continue;
    for (const bool forwards : {true, false}) {
      const Way way{start, forwards};
      if (!best || comes_first(way, *best)) best = way;
    }
  }
  std::vector<CurvePoint> turned;
  turned.reserve(count);
  for (std::size_t i = 0; i < count; ++i) turned.push_back(curve[place(best->start, i, best->forwards, count)]);
  curve = std::move(turned);
}

std::vector<std::vector<CurvePoint>> split_at_pinches(std::vector<CurvePoint> curve) {
  std::vector<Row> rows;  // then: those that the curve passes again
  for (const CurvePoint& p : curve) rows.push_back(p.vertex.row);
  std::sort(rows.begin(), rows.end());
  std::size_t count = 0;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    if (rows[i] == rows[i + 1] && (count == 0 || rows[count - 1] != rows[i])) rows[count++] = rows[i];
  }
  rows.resize(count);
  std::vector<std::vector<CurvePoint>> curves;
  if (rows.empty()) {
    curves.push_back(std::move(curve));
    return curves;
  }
  constexpr std::size_t kNone = SIZE_MAX;
  std::vector<std::size_t> places(rows.size(), kNone);  // on the path
  const auto place_of = [&](const CurvePoint& p) -> std::size_t* {
    const auto at = std::lower_bound(rows.begin(), rows.end(), p.vertex.row);
    return at != rows.end() && *at == p.vertex.row ? &places[static_cast<std::size_t>(at - rows.begin())]
                                                   : nullptr;
  };
  std::vector<CurvePoint> path;
  for (const CurvePoint& p : curve) {
    std::size_t* const place = place_of(p);
    if (place != nullptr && *place != kNone) {
      const auto back = path.begin() + static_cast<std::ptrdiff_t>(*place);
      curves.emplace_back(back, path.end());
      for (const CurvePoint& left : curves.back()) {
        if (std::size_t* const of_left = place_of(left); of_left != nullptr) *of_left = kNone;
      }
      path.erase(back, path.end());
    }
    if (place != nullptr) *place = path.size();
    path.push_back(p);
  }
  curves.push_back(std::move(path));
  for (std::vector<CurvePoint>& curve : curves) normalise(curve);
  return curves;
}

double confidence(std::span<const CurvePoint> curve, const TangentialConfig& config) {
  double sum = 0;
  for (const CurvePoint& p : curve) sum += std::min(p.excess / config.clear_excess, 1.0);
  return sum / (static_cast<double>(curve.size()) + config.doubt);
}

}  // namespace lacuna
