#include "engine/stages/rims.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <optional>

namespace lacuna {
namespace {

// Gaps as steps: a rim enters one from one neighbour and leaves it for the other.
class Follower {
 public:
  Follower(std::span<const Gap> gaps, Row first, Row last)
      : gaps_(gaps),
        first_(first),
        last_(last),
        begins_(value(last) - value(first) + 1),
        is_done_(gaps.size()) {
    for (const Gap& gap : gaps) ++begins_[value(gap.point.row) - value(first) + 1];
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  }

  void follow(const std::function<void(RimPart&)>& visit) {
    // Parts from one end to the other, then what is left is closed.
    for (const bool ends_only : {true, false}) {
      for (std::size_t g = 0; g < gaps_.size(); ++g) {
        if (is_done_[g]) continue;
        const bool enters = !is_here(gaps_[g].from), leaves = !is_here(gaps_[g].to);
        if (ends_only && !enters && !leaves) continue;
        RimPart part = walk(g, /*forwards=*/enters || !leaves);
        visit(part);
      }
    }
  }

 private:
  static constexpr std::size_t kNone = SIZE_MAX;

  bool is_here(Row row) const { return first_ <= row && row < last_; }

  // From an end on, where there is one.
  RimPart walk(std::size_t start, bool forwards) {
    RimPart part;
    part.before = forwards ? gaps_[start].from : gaps_[start].to;
    for (std::size_t g = start;;) {
      const Gap& gap = gaps_[g];
      is_done_[g] = true;
      part.points.push_back({gap.point, gap.room});
      part.after = forwards ? gap.to : gap.from;
      g = next(part.after, gap.point.row);
      if (g == kNone) {
        assert(!is_here(part.before) && !is_here(part.after));
        return part;
      }
      forwards = gaps_[g].from == gap.point.row;
      if (g == start) {
        part.is_closed = true;
        return part;
      }
    }
  }

  // The gap at `point` that ends at `neighbour`; there is at most one.
  std::size_t next(Row point, Row neighbour) const {
    if (!is_here(point)) return kNone;
    const std::size_t row = value(point) - value(first_);
    for (std::size_t g = begins_[row]; g < begins_[row + 1]; ++g) {
      if (gaps_[g].from == neighbour || gaps_[g].to == neighbour) return g;
    }
    return kNone;
  }

  std::span<const Gap> gaps_;
  Row first_, last_;
  std::vector<std::uint32_t> begins_;  // by row, the first gap
  std::vector<bool> is_done_;
};

// Place i of the rim as it is read from `start` on, in either direction.
std::size_t place(std::size_t start, std::size_t i, bool forwards, std::size_t count) {
  return forwards ? (start + i) % count : (start + count - i) % count;
}

}  // namespace

void follow_rims(std::span<const Gap> gaps, Row first, Row last, const std::function<void(RimPart&)>& visit) {
  Follower(gaps, first, last).follow(visit);
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

double confidence(std::span<const RimPoint> rim, const TangentialConfig& config) {
  double sum = 0;
  for (const RimPoint& p : rim) sum += std::min(p.room / config.clear_excess, 1.0);
  return sum / (static_cast<double>(rim.size()) + config.doubt);
}

}  // namespace lacuna
