#include "engine/boundary/tangential/curves.hpp"

#include "engine/store/row_numbers.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <optional>

namespace lacuna {
namespace {

// Place i of the rim as it is read from `start` on, in either direction.
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

void follow_curves(std::span<const Wedge> wedges, std::span<const WedgePartners> partners,
                   std::vector<bool> left_out, const std::function<void(std::vector<CurvePoint>&)>& visit) {
  std::vector<bool>& is_done = left_out;
  std::vector<CurvePoint> curve;
  for (LocalIndex start = 0; start < wedges.size(); ++start) {
    if (is_done[start]) continue;
    curve.clear();
    std::size_t side = wedges[start].from < wedges[start].to ? 1 : 0;  // where the curve goes on
    for (LocalIndex at = start; !is_done[at];) {
      const Wedge& wedge = wedges[at];
      is_done[at] = true;
      curve.push_back({wedge.point, wedge.room});
      at = partners[at][side];
      assert(at != kNoIndex);  // the curve is closed
      side = wedges[at].from == wedge.point.row ? 1 : 0;
    }
    visit(curve);
  }
}

void normalise(std::vector<CurvePoint>& rim) {
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
  for (const CurvePoint& p : rim) least = std::min(least, p.vertex.id);
  std::optional<Way> best;
  for (std::size_t start = 0; start < count; ++start) {
    if (rim[start].vertex.id != least) continue;
    for (const bool forwards : {true, false}) {
      const Way way{start, forwards};
      if (!best || comes_first(way, *best)) best = way;
    }
  }
  std::vector<CurvePoint> turned;
  turned.reserve(count);
  for (std::size_t i = 0; i < count; ++i) turned.push_back(rim[place(best->start, i, best->forwards, count)]);
  rim = std::move(turned);
}

std::vector<std::vector<CurvePoint>> split_at_pinches(std::vector<CurvePoint> rim) {
  std::vector<Row> rows;  // then: those that are passed again
  for (const CurvePoint& p : rim) rows.push_back(p.vertex.row);
  std::sort(rows.begin(), rows.end());
  std::size_t count = 0;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    if (rows[i] == rows[i + 1] && (count == 0 || rows[count - 1] != rows[i])) rows[count++] = rows[i];
  }
  rows.resize(count);
  std::vector<std::vector<CurvePoint>> curves;
  if (rows.empty()) {
    curves.push_back(std::move(rim));
    return curves;
  }
  constexpr std::size_t kNone = SIZE_MAX;
  std::vector<std::size_t> places(rows.size(), kNone);  // on the way
  const auto place_of = [&](const CurvePoint& p) -> std::size_t* {
    const auto at = std::lower_bound(rows.begin(), rows.end(), p.vertex.row);
    return at != rows.end() && *at == p.vertex.row ? &places[static_cast<std::size_t>(at - rows.begin())]
                                                   : nullptr;
  };
  std::vector<CurvePoint> way;
  for (const CurvePoint& p : rim) {
    std::size_t* const place = place_of(p);
    if (place != nullptr && *place != kNone) {
      const auto back = way.begin() + static_cast<std::ptrdiff_t>(*place);
      curves.emplace_back(back, way.end());
      for (const CurvePoint& left : curves.back()) {
        if (std::size_t* const of_left = place_of(left); of_left != nullptr) *of_left = kNone;
      }
      way.erase(back, way.end());
    }
    if (place != nullptr) *place = way.size();
    way.push_back(p);
  }
  curves.push_back(std::move(way));
  for (std::vector<CurvePoint>& curve : curves) normalise(curve);
  return curves;
}

double confidence(std::span<const CurvePoint> rim, const TangentialConfig& config) {
  double sum = 0;
  for (const CurvePoint& p : rim) sum += std::min(p.room / config.clear_excess, 1.0);
  return sum / (static_cast<double>(rim.size()) + config.doubt);
}

}  // namespace lacuna
