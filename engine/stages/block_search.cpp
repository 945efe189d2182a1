#include "engine/stages/block_search.hpp"

#include "engine/core/dispatch.hpp"
#include "engine/core/vector_math.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace lacuna {
namespace {

constexpr std::size_t kBlock = 16;
constexpr std::size_t kFan = 8;
constexpr std::size_t kMostBlocks = 128;      // around a block of queries; more: the order jumps here
constexpr std::size_t kMostCandidates = 192;  // of one query; more: ranking by counting is slow
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// A query's neighbours are looked for within this multiple of the last ones' distance, and blocks of a
// whole run of queries within a little more.
constexpr double kGuess = 1.2;
constexpr double kRunGuess = 1.4;

// Bounds are widened by more than rounding can have narrowed them.
constexpr double kSlack = 1 + 1e-12;

struct Box {
  std::array<double, 3> low{kInfinite, kInfinite, kInfinite};
  std::array<double, 3> high{-kInfinite, -kInfinite, -kInfinite};

  void extend(const Eigen::Vector3d& p) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
};

}  // namespace

// Boxes of one level, one array per side, padded to whole groups with empty boxes.
struct BlockSearch::Boxes {
  std::array<std::vector<double>, 3> low, high;

  explicit Boxes(std::size_t count) {
    const std::size_t padded = (count + kFan - 1) / kFan * kFan;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis].assign(padded, kInfinite);
      high[axis].assign(padded, -kInfinite);
    }
  }
  std::size_t size() const { return low[0].size(); }
};

// Blocks within sight of a run of queries, and one query's candidates among their points.
struct BlockSearch::Candidates {
  LocalIndex first = 0, last = 0;  // the run
  double radius = 0;               // around the run's box
  std::vector<std::uint32_t> blocks;
  std::array<std::array<double, kMostBlocks>, 3> low, high;  // the blocks' boxes
  std::array<double, kMostBlocks> gap;                       // squared distance from the query

  std::size_t count = 0;
  std::array<double, kMostBlocks * kBlock + kBlock> squared_distance;
  std::array<LocalIndex, kMostBlocks * kBlock + kBlock> index;
  std::array<std::uint32_t, lanes(kMostCandidates)> rank;
  std::array<LocalIndex, kMostCandidates> place;  // of each rank, the candidate that has it
};

namespace {

using Group = std::array<double, kFan>;

// Squared distances between a box and eight.
LACUNA_VECTORISED
void box_gaps(const Box& box, const double* const low[3], const double* const high[3], Group& gaps) {
  Group sum{};
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < kFan; ++i) {
      const double below = low[axis][i] - box.high[axis], above = box.low[axis] - high[axis][i];
      const double gap = std::max(std::max(below, above), 0.0);
      sum[i] += gap * gap;
    }
  }
  gaps = sum;
}

LACUNA_VECTORISED
void point_gaps(double x, double y, double z, std::size_t count, const double* const low[3],
                const double* const high[3], double* gaps) {
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = std::max(std::max(low[0][i] - x, x - high[0][i]), 0.0);
    const double dy = std::max(std::max(low[1][i] - y, y - high[1][i]), 0.0);
    const double dz = std::max(std::max(low[2][i] - z, z - high[2][i]), 0.0);
    gaps[i] = (dx * dx + dy * dy) + dz * dz;
  }
}

// What the points of one block are compared with, and where those within the radius go.
struct Query {
  double x, y, z, squared_radius;
};
struct Within {
  double* squared_distances;
  LocalIndex* indices;
  std::size_t count;
};

// Appends the points of one block that lie within the radius. Writes up to a block beyond the count.
LACUNA_VECTORISED
void append_within(const double* block, const Query& query, LocalIndex first_index, Within& within) {
  std::array<double, kBlock> d;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const double dx = block[i] - query.x, dy = block[kBlock + i] - query.y,
                 dz = block[2 * kBlock + i] - query.z;
    d[i] = (dx * dx + dy * dy) + dz * dz;
  }
  for (std::size_t i = 0; i < kBlock; ++i) {
    within.squared_distances[within.count] = d[i];
    within.indices[within.count] = first_index + static_cast<LocalIndex>(i);
    within.count += d[i] <= query.squared_radius;
  }
}

#ifdef LACUNA_AVX512
// The same with the instruction that compilers do not find: compression.
LACUNA_AVX512 void append_within_avx512(const double* block, const Query& query, LocalIndex first_index,
                                        Within& within) {
  const __m512d x = _mm512_set1_pd(query.x), y = _mm512_set1_pd(query.y), z = _mm512_set1_pd(query.z);
  const __m512d squared_radius = _mm512_set1_pd(query.squared_radius);
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  for (std::size_t half = 0; half < kBlock; half += 8) {
    const __m512d dx = _mm512_sub_pd(_mm512_loadu_pd(block + half), x);
    const __m512d dy = _mm512_sub_pd(_mm512_loadu_pd(block + kBlock + half), y);
    const __m512d dz = _mm512_sub_pd(_mm512_loadu_pd(block + 2 * kBlock + half), z);
    const __m512d xy = _mm512_add_pd(_mm512_mul_pd(dx, dx), _mm512_mul_pd(dy, dy));
    const __m512d d = _mm512_add_pd(xy, _mm512_mul_pd(dz, dz));
    const __mmask8 near = _mm512_cmp_pd_mask(d, squared_radius, _CMP_LE_OQ);
    const __m256i index = _mm256_add_epi32(lanes, _mm256_set1_epi32(static_cast<int>(first_index + half)));
    _mm512_storeu_pd(within.squared_distances + within.count, _mm512_maskz_compress_pd(near, d));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(within.indices + within.count),
                        _mm256_maskz_compress_epi32(near, index));
    within.count += static_cast<std::size_t>(std::popcount(static_cast<unsigned>(near)));
  }
}

const auto kAppendWithin = has_avx512() ? append_within_avx512 : append_within;
#else
constexpr auto kAppendWithin = append_within;
#endif

}  // namespace

BlockSearch::BlockSearch(std::span<const Eigen::Vector3d> positions, std::span<const PointId> ids)
    : positions_(positions), ids_(ids), candidates_(std::make_unique<Candidates>()) {
  const std::size_t blocks = (positions.size() + kBlock - 1) / kBlock;
  coordinates_.assign(blocks * 3 * kBlock, kInfinite);
  levels_.emplace_back(blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    Box box;
    const std::size_t end = std::min((b + 1) * kBlock, positions.size());
    for (std::size_t i = b * kBlock; i < end; ++i) {
      box.extend(positions[i]);
      for (int axis = 0; axis < 3; ++axis) {
        coordinates_[(b * 3 + static_cast<std::size_t>(axis)) * kBlock + i % kBlock] = positions[i][axis];
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      levels_[0].low[axis][b] = box.low[axis];
      levels_[0].high[axis][b] = box.high[axis];
    }
  }
  while (levels_.back().size() > kFan) {
    const Boxes& below = levels_.back();
    const std::size_t count = below.size() / kFan;
    Boxes level(count);
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < count; ++i) {
        const auto low = below.low[axis].begin() + static_cast<std::ptrdiff_t>(i * kFan);
        const auto high = below.high[axis].begin() + static_cast<std::ptrdiff_t>(i * kFan);
        level.low[axis][i] = *std::min_element(low, low + kFan);
        level.high[axis][i] = *std::max_element(high, high + kFan);
      }
    }
    levels_.push_back(std::move(level));
  }
}

BlockSearch::~BlockSearch() = default;

void BlockSearch::find(LocalIndex query, LocalIndex last, std::size_t k) {
  const Candidates& c = *candidates_;
  const LocalIndex block_end = std::min<LocalIndex>(last, (query / kBlock + 1) * kBlock);
  const auto in_sight = [&](double radius) {
    return query >= c.first && query < c.last && radius <= c.radius;
  };

  // More than k points within any radius, the query among them, hold its k neighbours: so a good guess will
  // do, and is right or found out. Neighbours of the last queries are about as far as this one's.
  bool found = false;
  if (guess_ > 0) {
    const double radius = kGuess * guess_;
    if (in_sight(radius) || look_around(query, block_end, kRunGuess * guess_)) found = rank(query, radius, k);
  }
  if (!found) {
    const double radius = reach_of(query, k);
    if (in_sight(radius) || look_around(query, query + 1, radius)) {
      rank(query, radius, k);
    } else {
      if (!tree_) tree_.emplace(positions_, ids_);
      tree_->nearest(query, k, found_);
    }
  }
  if (found_.empty()) return;
  refuse_underflow(found_.front().squared_distance, ids_[query], found_.front().id);
  const double radius = std::sqrt(found_.back().squared_distance);
  guess_ = std::max(radius, last_radius_);
  last_radius_ = radius;
}

// No less than the distance to the query's k-th neighbour.
double BlockSearch::reach_of(LocalIndex query, std::size_t k) {
  if (positions_.size() <= k + 1) return kInfinite;
  // Any k points will do; those beside the query in the order are near. The query itself is at 0.
  const std::size_t first = query > k ? query - k : 0;
  const std::size_t last = std::min<std::size_t>(query + k + 1, positions_.size());
  beside_.clear();
  for (std::size_t i = first; i < last; ++i)
    beside_.push_back(squared_distance(positions_[query], positions_[i]));
  const auto kth = beside_.begin() + static_cast<std::ptrdiff_t>(k);
  std::nth_element(beside_.begin(), kth, beside_.end());
  return std::sqrt(*kth) * kSlack;
}

// Finds all blocks within `radius` of any query of [first, last). False if they are too many.
bool BlockSearch::look_around(LocalIndex first, LocalIndex last, double radius) {
  Candidates& c = *candidates_;
  c.first = c.last = first;
  c.blocks.clear();
  c.radius = radius;
  Box run;
  for (LocalIndex q = first; q < last; ++q) run.extend(positions_[q]);
  const double squared_radius = radius * radius * kSlack;

  struct Place {
    std::size_t level, group;
  };
  std::array<Place, 128> stack;
  std::size_t depth = 0;
  stack[depth++] = {levels_.size() - 1, 0};
  while (depth > 0) {
    const auto [level, group] = stack[--depth];
    const Boxes& boxes = levels_[level];
    const double* low[3];
    const double* high[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = boxes.low[axis].data() + group * kFan;
      high[axis] = boxes.high[axis].data() + group * kFan;
    }
    Group gaps;
    box_gaps(run, low, high, gaps);
    for (std::size_t i = kFan; i-- > 0;) {
      if (!(gaps[i] <= squared_radius) || !(low[0][i] <= high[0][i])) continue;  // far, or empty
      if (level > 0) {
        stack[depth++] = {level - 1, group * kFan + i};
        continue;
      }
      if (c.blocks.size() == kMostBlocks) return false;
      for (int axis = 0; axis < 3; ++axis) {
        c.low[axis][c.blocks.size()] = low[axis][i];
        c.high[axis][c.blocks.size()] = high[axis][i];
      }
      c.blocks.push_back(static_cast<std::uint32_t>(group * kFan + i));
    }
  }
  c.last = last;
  return true;
}

// The first k of all points within `radius`; false if these are no more than k and not all.
bool BlockSearch::rank(LocalIndex query, double radius, std::size_t k) {
  Candidates& c = *candidates_;
  // Never infinite: at infinity lies the padding beyond the last point.
  const double squared_radius = std::min(radius * radius * kSlack, std::numeric_limits<double>::max());
  const Eigen::Vector3d& p = positions_[query];
  const double* const low[3] = {c.low[0].data(), c.low[1].data(), c.low[2].data()};
  const double* const high[3] = {c.high[0].data(), c.high[1].data(), c.high[2].data()};
  point_gaps(p.x(), p.y(), p.z(), c.blocks.size(), low, high, c.gap.data());
  const Query around{p.x(), p.y(), p.z(), squared_radius};
  Within within{c.squared_distance.data(), c.index.data(), 0};
  for (std::size_t b = 0; b < c.blocks.size(); ++b) {
    if (c.gap[b] > squared_radius) continue;
    kAppendWithin(coordinates_.data() + std::size_t{c.blocks[b]} * 3 * kBlock, around,
                  static_cast<LocalIndex>(c.blocks[b] * kBlock), within);
  }
  const std::size_t count = within.count;
  if (count <= k && count < positions_.size()) return false;

  // Rank 0 is the query itself. Ties share a rank and leave another empty: then, and where candidates are
  // many, sort.
  const std::size_t wanted = std::min(k + 1, count);
  found_.clear();
  if (count <= kMostCandidates) {
    count_smaller(c.squared_distance.data(), count, c.rank.data());
    std::fill_n(c.place.begin(), std::min(wanted + 1, count), kNoIndex);
    for (LocalIndex i = 0; i < count; ++i) c.place[c.rank[i]] = i;
    for (std::size_t rank = 1; rank < wanted && c.place[rank] != kNoIndex; ++rank) {
      const LocalIndex i = c.place[rank];
      found_.push_back({c.squared_distance[i], ids_[c.index[i]], c.index[i]});
    }
    const bool last_tied = wanted < count && c.place[wanted] == kNoIndex;
    if (found_.size() + 1 == wanted && !last_tied) return true;
  }
  found_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if (c.index[i] != query) found_.push_back({c.squared_distance[i], ids_[c.index[i]], c.index[i]});
  }
  std::partial_sort(found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(wanted - 1), found_.end());
  found_.resize(wanted - 1);
  return true;
}

}  // namespace lacuna
