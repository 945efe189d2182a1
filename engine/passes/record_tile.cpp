#include "engine/passes/record_tile.hpp"

#include "engine/core/dispatch.hpp"
#include "engine/stages/orient.hpp"
#include "engine/stages/tile_stars.hpp"

#include <algorithm>
#include <utility>

namespace lacuna {
namespace {

LACUNA_VECTORISED
LocalIndex largest_of(const LocalIndex* first, const LocalIndex* last) {
  LocalIndex largest = 0;
  for (; first < last; ++first) largest = std::max(largest, *first);
  return largest;
}

// A byte for each row: whether it holds an index of `least` or more. Few do, and these near each other.
std::vector<std::uint8_t> rows_with(LocalIndex least, const Rows& rows) {
  constexpr std::size_t kRun = 64;
  std::vector<std::uint8_t> has(rows.size());
  const auto run_has = [&](std::size_t first, std::size_t last) {
    const LocalIndex* const indices = rows.indices.data();
    return largest_of(indices + rows.offsets[first], indices + rows.offsets[last]) >= least;
  };
  for (std::size_t first = 0, last; first < has.size(); first = last) {
    last = std::min(first + kRun, has.size());
    if (!run_has(first, last)) continue;
    for (std::size_t row = first; row < last; ++row) has[row] = run_has(row, row + 1);
  }
  return has;
}

class TileRecorder {
 public:
  TileRecorder(const EvaluatedTile& tile, EvaluatedScan& scan, const TileStore& store, const Job& job)
      : tile_(tile.index),
        points_(tile.points),
        neighbourhoods_(tile.neighbourhoods),
        evaluations_(tile.evaluations),
        scan_(scan),
        store_(store),
        job_(job) {}

  void record() {
    is_border_ = rows_with(points_.owned, neighbourhoods_);
    if (job_.config.loops.method == LoopMethod::kPaper) {
      record_strengths();
      record_edges();
    } else {
      record_stars();
    }
    record_candidates();
    if (job_.config.output.points) record_results();
    if (job_.config.normals.orient) record_orientation();
  }

  const Totals& totals() const { return totals_; }
  // Tiles that own gap neighbours of this tile's candidates.
  const std::vector<TileIndex>& leans_on() const { return leans_on_; }

 private:
  StoredPoint stored(LocalIndex p) const {
    const Eigen::Vector3d& x = points_.positions[p];
    return {x.x(), x.y(), x.z(), points_.ids[p]};
  }
  Vertex vertex(LocalIndex p) const { return {points_.ids[p], points_.rows[p]}; }
  float probability(LocalIndex p) const { return static_cast<float>(evaluations_[p].probability); }
  Strength strength(LocalIndex p) const { return {evaluations_[p].mean_distance, probability(p)}; }

  // Other tiles ask for what a column holds of points near theirs: runs of the tile's rows that hold none of
  // those stay unwritten. record(p): what is written of a point.
  template <class Record, class Recorded>
  void record_runs(Column<Record>& column, std::span<const std::uint8_t> is_wanted, Recorded&& record) {
    constexpr LocalIndex kRun = 64;
    const std::uint64_t first_row = value(store_.tiling().tiles[tile_].first_row);
    std::vector<Record> records;
    const auto write = [&](LocalIndex end) {
      if (!records.empty()) column.write(first_row + end - records.size(), records);
      records.clear();
    };
    for (LocalIndex begin = 0, end; begin < points_.owned; begin = end) {
      end = std::min(begin + kRun, points_.owned);
      if (std::any_of(is_wanted.begin() + begin, is_wanted.begin() + end,
                      [](bool wanted) { return wanted; })) {
        for (LocalIndex p = begin; p < end; ++p) records.push_back(record(p));
      } else {
        write(begin);
      }
    }
    write(points_.owned);
  }

  void record_strengths() {
    record_runs(scan_.edges.strengths, is_border_, [&](LocalIndex p) { return strength(p); });
  }

  void record_stars() {
    const TileStars found = find_stars(points_, neighbourhoods_, evaluations_, is_border_,
                                       job_.config.coherence.threshold, job_.config.tangential);
    StoredStars as_found, open;
    std::vector<Gap> gaps;
    std::vector<std::uint8_t> is_vertex = is_border_;
    for (LocalIndex p = 0; p < points_.owned; ++p) {
      const Standing standing = found.standings[p];
      if (found.is_rough[p]) scan_.stars.rough.insert(points_.rows[p]);
      if (waits(standing)) scan_.stars.unmeasured.insert(points_.rows[p]);
      if (standing == Standing::kInner || standing == Standing::kBorder) continue;
      const auto agreements = found.stars.agreements_of(p);
      const auto all_are = [&](auto... these) {
        return std::all_of(agreements.begin(), agreements.end(),
                           [&](Agreement a) { return ((a == these) || ...); });
      };
      if (standing == Standing::kRough && all_are(Agreement::kAgreed)) continue;
      is_vertex[p] = 1;
      if (standing == Standing::kRough && all_are(Agreement::kAgreed, Agreement::kRefused)) {
        for_each_gap(found.stars[p], agreements, [&](LocalIndex from, LocalIndex to, float room) {
          gaps.push_back({vertex(p), points_.rows[from], points_.rows[to], room});
        });
      } else {
        add_star(found, p, standing == Standing::kBeside ? as_found : open);
      }
    }
    record_waiting(found);
    scan_.stars.found.append(tile_, std::move(as_found));
    scan_.stars.open.append(tile_, std::move(open));
    scan_.stars.gaps.append(tile_, gaps);
    record_vertices(is_vertex);
  }

  void add_star(const TileStars& found, LocalIndex p, StoredStars& stars) const {
    const auto star = found.stars[p];
    const auto agreements = found.stars.agreements_of(p);
    if (star.empty()) return;
    stars.add(points_.ids[p], p);
    for (std::size_t i = 0; i < star.size(); ++i)
      stars.add_corner({points_.rows[star[i].point], star[i].room, agreements[i]});
  }

  // Marks owned points, by is_wanted(p), and all of their neighbours.
  template <class Wanted>
  std::vector<std::uint8_t> with_neighbours(Wanted&& is_wanted) const {
    std::vector<std::uint8_t> marks(points_.size());
    for (LocalIndex p = 0; p < points_.owned; ++p) {
      if (!is_wanted(p)) continue;
      marks[p] = 1;
      for (const LocalIndex q : neighbourhoods_[p]) marks[q] = 1;
    }
    return marks;
  }

  Seat seat(LocalIndex p) const { return seat_of(points_.positions[p], points_.ids[p], evaluations_[p]); }

  // What the stars of waiting points need, here and in other tiles.
  void record_waiting(const TileStars& found) {
    const std::vector<std::uint8_t> is_seen =
        with_neighbours([&](LocalIndex p) { return waits(found.standings[p]); });
    std::vector<LocalIndex> seen;
    for (LocalIndex p = 0; p < points_.size(); ++p) {
      if (is_seen[p]) seen.push_back(p);
    }
    // By row: both the owned and the foreign ones are.
    std::inplace_merge(seen.begin(), std::lower_bound(seen.begin(), seen.end(), points_.owned), seen.end(),
                       [&](LocalIndex a, LocalIndex b) { return points_.rows[a] < points_.rows[b]; });
    std::vector<LocalIndex> place(points_.size());
    std::vector<SeenPoint> in_sight;
    std::vector<Row> rows;
    for (const LocalIndex p : seen) {
      rows.push_back(points_.rows[p]);
      place[p] = static_cast<LocalIndex>(in_sight.size());
      in_sight.push_back({vertex(p), points_.is_owned(p) ? found.samplings[p] : Sampling{}});
    }

    std::vector<WaitingPoint> waiting;
    std::vector<LocalIndex> neighbours;
    for (LocalIndex p = 0; p < points_.owned; ++p) {
      if (!waits(found.standings[p])) continue;
      const Eigen::Vector3d& normal = evaluations_[p].normal;
      const auto around = neighbourhoods_[p];
      waiting.push_back({place[p],
                         static_cast<std::uint32_t>(around.size()),
                         found.standings[p],
                         {normal.x(), normal.y(), normal.z()}});
      for (const LocalIndex q : around) neighbours.push_back(place[q]);
    }
    scan_.stars.waiting.append(tile_, waiting);
    scan_.stars.waiting_neighbours.append(tile_, neighbours);
    scan_.stars.waiting_sight.append(tile_, in_sight);
    scan_.stars.around[tile_] = store_.tiling().tiles_of(rows);
    const std::vector<std::uint8_t> is_seated =
        with_neighbours([&](LocalIndex p) { return is_border_[p] != 0; });
    record_runs(scan_.stars.seats, std::span(is_seated).first(points_.owned),
                [&](LocalIndex p) { return seat(p); });
  }

  // Points that may end up on a loop.
  void record_vertices(std::span<const std::uint8_t> is_vertex) {
    std::vector<StoredVertex> vertices;
    for (LocalIndex p = 0; p < points_.owned; ++p) {
      if (!is_vertex[p]) continue;
      const Eigen::Vector3f surface = evaluations_[p].mean_offset.cast<float>();
      vertices.push_back({p, probability(p), {surface.x(), surface.y(), surface.z()}, stored(p)});
    }
    scan_.vertices.append(tile_, vertices);
  }

  void record_edges() {
    const TileEdges edges = eligible_edges(points_, neighbourhoods_, evaluations_, job_.config.spanning);
    scan_.edges.inside.append(tile_, edges.inside);
    std::vector<StoredCrossing> crossings;
    for (const Crossing& c : edges.crossings)
      crossings.push_back({vertex(c.owned), vertex(c.foreign), strength(c.owned), c.distance});
    scan_.edges.crossings.append(tile_, crossings);

    // Ends of eligible edges; of edges between tiles another tile may tell, so all with foreign neighbours.
    std::vector<std::uint8_t> is_vertex = is_border_;
    for (const TileEdge& edge : edges.inside) is_vertex[edge.a] = is_vertex[edge.b] = 1;
    record_vertices(is_vertex);
  }

  void count(const Evaluation& e, std::size_t neighbours) {
    ++totals_.points;
    totals_.neighbours += neighbours;
    totals_.candidates += e.probability > job_.config.coherence.threshold;
    totals_.undefined_normals += !e.normal.allFinite();
    const double length = e.mean_distance * static_cast<double>(neighbours) / scan_.totals.length_unit;
    constexpr double kShort = 0x1p62;  // what fits is converted in one instruction
    totals_.edge_length += length < kShort ? static_cast<std::int64_t>(length) : static_cast<Int128>(length);
  }

  // And counts all points by the way: their evaluations do not fit in the cache.
  void record_candidates() {
    std::vector<StoredCandidate> candidates;
    for (LocalIndex p = 0; p < points_.owned; ++p) {
      const Evaluation& e = evaluations_[p];
      count(e, neighbourhoods_[p].size());
      if (!(e.probability > job_.config.coherence.threshold) || e.gap_near == kNoIndex) continue;
      candidates.push_back(
          {{points_.rows[p], points_.rows[e.gap_near], points_.rows[e.gap_far]}, stored(p), probability(p)});
      for (const LocalIndex gap : {e.gap_near, e.gap_far}) {
        if (!points_.is_owned(gap)) leans_on_.push_back(store_.tiling().tile_of_row(points_.rows[gap]));
      }
    }
    std::sort(leans_on_.begin(), leans_on_.end());
    leans_on_.erase(std::unique(leans_on_.begin(), leans_on_.end()), leans_on_.end());
    scan_.candidates.append(tile_, candidates);
  }

  StoredResult result(PointId id, LocalIndex p) const {
    const Evaluation& e = evaluations_[p];
    StoredResult result{.id = id, .row = points_.rows[p], .probability = probability(p)};
    for (std::size_t i = 0; i < kCriteria; ++i) result.criteria[i] = static_cast<float>(e.criteria[i]);
    for (int axis = 0; axis < 3; ++axis) result.normal[axis] = static_cast<float>(e.normal[axis]);
    return result;
  }

  // By block of ids, duplicates with the results of the point that stands for them.
  void record_results() {
    std::vector<StoredResult> results;
    for (LocalIndex p = 0; p < points_.owned; ++p) results.push_back(result(points_.ids[p], p));
    for (const Duplicate& d : store_.duplicates(tile_)) results.push_back(result(d.id, d.of));
    std::sort(results.begin(), results.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    for (std::size_t begin = 0, end; begin < results.size(); begin = end) {
      const std::uint64_t block = value(results[begin].id) / kResultBlock;
      for (end = begin; end < results.size() && value(results[end].id) / kResultBlock == block;) ++end;
      scan_.results.append(block, std::span(results).subspan(begin, end - begin));
    }
  }

  // An edge that is the heaviest on a cycle inside one tile is in no minimum spanning tree, so of the edges
  // inside only the tile's own spanning forest goes on.
  void record_orientation() {
    std::vector<StoredNormal> normals;
    for (const Evaluation& e : evaluations_) normals.push_back({e.normal.x(), e.normal.y(), e.normal.z()});
    scan_.normals.write(value(store_.tiling().tiles[tile_].first_row), normals);

    std::vector<OrientationEdge> edges;
    std::vector<OrientationCrossing> crossings;
    const std::uint64_t first_row = value(store_.tiling().tiles[tile_].first_row);
    for (LocalIndex p = 0; p < points_.owned; ++p) {
      if (!evaluations_[p].normal.allFinite()) continue;
      for (const LocalIndex q : neighbourhoods_[p]) {
        if (!(points_.ids[p] < points_.ids[q])) continue;
        if (!points_.is_owned(q)) {
          crossings.push_back({p, points_.rows[q], points_.ids[q]});
        } else if (evaluations_[q].normal.allFinite()) {
          edges.push_back(orientation_edge({points_.ids[p], points_.rows[p], evaluations_[p].normal},
                                           {points_.ids[q], points_.rows[q], evaluations_[q].normal}));
        }
      }
    }
    scan_.orientation.append(tile_, spanning_forest(std::move(edges), first_row, points_.owned));
    scan_.orientation_crossings.append(tile_, crossings);
  }

  TileIndex tile_;
  const TilePoints& points_;
  const Rows& neighbourhoods_;
  const std::vector<Evaluation>& evaluations_;
  EvaluatedScan& scan_;
  const TileStore& store_;
  const Job& job_;
  std::vector<std::uint8_t> is_border_;  // has foreign neighbours
  Totals totals_;
  std::vector<TileIndex> leans_on_;
};

}  // namespace

TileNumbers record_tile(const EvaluatedTile& tile, EvaluatedScan& scan, const TileStore& store,
                        const Job& job) {
  TileRecorder recorder(tile, scan, store, job);
  recorder.record();
  return {recorder.totals(), recorder.leans_on()};
}

}  // namespace lacuna
