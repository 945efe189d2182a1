// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/boundary/tangential/consistency.cpp"
// Each target includes what follows foreach_target.h.
// clang-format off
#include "engine/boundary/tangential/active_points.hpp"
#include "engine/simd/targets.hpp"
#include <hwy/foreach_target.h>
#include "engine/simd/mask-inl.hpp"
// clang-format on

#include <algorithm>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace lacuna::tangential::HWY_NAMESPACE {
using namespace lacuna::HWY_NAMESPACE;

namespace {

constexpr std::uint32_t kNone = UINT32_MAX;

// Bit 2 i is set where vertex i of the first kFewVertices is that point.
HWY_INLINE std::uint32_t places_of(LocalIndex point, const LinkVertex<LocalIndex>* link) {
  constexpr hn::CappedTag<std::uint32_t, 2 * kFewVertices> kVertices;
  if constexpr (kLanes<decltype(kVertices)> == 2 * kFewVertices) {  // a point and a radius each
    const auto vertices = hn::LoadU(kVertices, reinterpret_cast<const std::uint32_t*>(link));
    return bits_of(kVertices, vertices == hn::Set(kVertices, point)) & 0x5555;
  } else {
    std::uint32_t places = 0;
    for (std::uint32_t i = 0; i < kFewVertices; ++i)
      places |= static_cast<std::uint32_t>(link[i].point == point) << 2 * i;
    return places;
  }
}

// Returns the vertex of a large link after which b follows a, or a follows b.
std::uint32_t find_in_large_link(const LinkVertex<LocalIndex>* link, std::uint32_t size, LocalIndex a,
                                 LocalIndex b) {
  for (std::uint32_t i = 0; i < size; ++i) {
    const LocalIndex here = link[i].point, next = link[i + 1 < size ? i + 1 : 0].point;
    if ((here == a && next == b) || (here == b && next == a)) return i;
  }
  return kNone;
}

// Returns the link vertex at which the point's triangle with a and b begins. Returns kNone where its star
// does not have the triangle within the coarse bound.
HWY_INLINE std::uint32_t find_triangle(const StarTable& stars, LocalIndex point, LocalIndex a, LocalIndex b) {
  const auto [begin, size, bound] = stars.places[point];
  const LinkVertex<LocalIndex>* const link = stars.vertices + begin;
  std::uint32_t place = kNone;
  if (size <= kFewVertices) {
    const std::uint32_t all = (1U << 2 * size) - 1;
    const std::uint32_t at_a = places_of(a, link) & all, at_b = places_of(b, link) & all;
    const auto next = [&](std::uint32_t at) HWY_ATTR { return at << 2 | at >> ((2 * size - 2) & 31); };
    const std::uint32_t at = (next(at_a) & at_b) != 0 ? at_a : (next(at_b) & at_a) != 0 ? at_b : 0;
    if (at != 0) place = static_cast<std::uint32_t>(__builtin_ctz(at)) / 2;
  } else {
    place = find_in_large_link(link, size, a, b);
  }
  return place != kNone && link[place].radius <= bound.coarse ? begin + place : kNone;
}

}  // namespace

void compare_triangles(const StarTable& stars, const TriangleQuery* queries, std::size_t count) {
  for (const TriangleQuery* query = queries; query < queries + count; ++query) {
    const auto [vertex, p, a, b] = *query;
    const PointState of_a = stars.states[a], of_b = stars.states[b];
    std::uint32_t in_a = vertex, in_b = vertex;
    if (of_a == PointState::kActive && (in_a = find_triangle(stars, a, p, b)) == kNone) continue;
    if (of_b == PointState::kActive && (in_b = find_triangle(stars, b, p, a)) == kNone) continue;
    const auto is_unknown = [](PointState state) HWY_ATTR {
      return state != PointState::kActive && state != PointState::kInactive;
    };
    const bool is_open = is_unknown(of_a) || is_unknown(of_b);
    const auto scale = [&](LocalIndex point, std::uint32_t at)
                           HWY_ATTR { return stars.places[point].bound.scale_of(stars.vertices[at].radius); };
    Scale coarsest = scale(p, vertex);
    if (in_a != vertex) coarsest = std::max(coarsest, scale(a, in_a));
    if (in_b != vertex) coarsest = std::max(coarsest, scale(b, in_b));
    const Consistency consistency{coarsest, is_open};
    stars.consistencies[vertex] = stars.consistencies[in_a] = stars.consistencies[in_b] = consistency;
  }
}

}  // namespace lacuna::tangential::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lacuna::tangential {

HWY_EXPORT(compare_triangles);

namespace {

// Writes the triangles in the stars of active points [first, last), each in the star of its lowest active
// point, to `queries`. Returns how many. It works without a branch: processors cannot predict which star that
// is.
std::size_t list_triangles(const Stars<LocalIndex>& stars, std::span<const PointState> states,
                           LocalIndex first, LocalIndex last, TriangleQuery* queries) {
  const auto is_lower_active = [&](LocalIndex p, LocalIndex q) {
    return (q < p) & (states[q] == PointState::kActive);
  };
  std::size_t count = 0;
  for (LocalIndex p = first; p < last; ++p) {
    const auto [begin, size, bound] = stars.places[p];
    if (size == 0 || states[p] != PointState::kActive) continue;
    const LinkVertex<LocalIndex>* a = &stars.vertices[begin + size - 1];
    bool is_by_a = is_lower_active(p, a->point);
    for (std::uint32_t i = begin; i < begin + size; ++i) {
      const LinkVertex<LocalIndex>* const b = &stars.vertices[i];
      const bool is_by_b = is_lower_active(p, b->point);
      queries[count] = {static_cast<std::uint32_t>(a - stars.vertices.data()), p, a->point, b->point};
      count += !(is_by_a | is_by_b) & (a->radius <= bound.coarse);
      a = b;
      is_by_a = is_by_b;
    }
  }
  return count;
}

}  // namespace

void decide_consistency(Stars<LocalIndex>& stars, std::span<const PointState> states) {
  stars.consistencies.resize(stars.vertices.size());
  const StarTable table{stars.places.data(), stars.vertices.data(), states.data(),
                        stars.consistencies.data()};
  constexpr LocalIndex kRun = 64;
  const auto points = static_cast<LocalIndex>(stars.size());
  std::vector<TriangleQuery> queries;
  for (LocalIndex first = 0; first < points; first += kRun) {
    const LocalIndex last = std::min(first + kRun, points);
    std::size_t most = 1;
    for (LocalIndex p = first; p < last; ++p) most += stars.places[p].size;
    if (queries.size() < most) queries.resize(2 * most);
    const std::size_t count = list_triangles(stars, states, first, last, queries.data());
    HWY_DYNAMIC_DISPATCH(compare_triangles)(table, queries.data(), count);
  }
  for (LocalIndex p = 0; p < points; ++p) {
    if (states[p] != PointState::kMaybeActive) continue;
    const Star<LocalIndex> star = stars[p];
    for (std::size_t i = 0; i < star.size(); ++i)
      stars.consistencies_of(p)[i] = {star.scale_of(i), star.scale_of(i) != Scale::kNone};
  }
}

}  // namespace lacuna::tangential
#endif
