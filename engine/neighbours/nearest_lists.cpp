// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/neighbours/nearest_lists.cpp"
// Each target includes what follows foreach_target.h.
// clang-format off
#include "engine/neighbours/nearest_lists.hpp"
#include "engine/simd/targets.hpp"
#include <hwy/foreach_target.h>
#include "engine/simd/mask-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {
namespace {

using Numbers = hn::CappedTag<std::uint32_t, kListLine>;
constexpr Numbers kNumbers;
using V = hn::Vec<Numbers>;

// Returns which places of the line hold such a point.
template <class IsChosen>
HWY_INLINE std::uint32_t places(const ListLine& line, IsChosen&& is_chosen) {
  std::uint32_t chosen = 0;
  for (std::size_t place = 0; place < kListLine; place += kLanes<Numbers>)
    chosen |= bits_of(kNumbers, is_chosen(hn::Load(kNumbers, line.points + place))) << place;
  return chosen;
}

// `stride`: the stride of the lists, best known when this is compiled.
HWY_INLINE void find_mutual_in(const NearestLists& lists, std::size_t stride, std::uint32_t first,
                               std::uint32_t last) {
  for (std::uint32_t p = first; p < last; ++p) {
    const V all_p = hn::Set(kNumbers, p);
    const std::size_t begin = p * stride;
    for (std::size_t own = begin; own < begin + stride; ++own) {
      const ListLine& line = lists.lines[own];
      std::uint32_t mutual = 0;
      for (std::uint32_t left = places(line, [&](V q) HWY_ATTR { return q < all_p; }); left != 0;
           left &= left - 1) {
        const std::size_t q = line.points[__builtin_ctz(left)];
        std::uint32_t some = 0;
        for (std::size_t other = q * stride; other < q * stride + stride; ++other) {
          const std::uint32_t at =
              places(lists.lines[other], [&](V points) HWY_ATTR { return points == all_p; });
          lists.mutual[other] |= static_cast<std::uint16_t>(at);
          some |= at;
        }
        mutual |=
            left & -left & -std::uint32_t{some != 0};  // without a branch, which no processor could predict
      }
      lists.mutual[own] = static_cast<std::uint16_t>(mutual);
    }
  }
}

}  // namespace

void find_mutual(const NearestLists& lists, std::uint32_t first, std::uint32_t last) {
  if (lists.stride == 1) {
    find_mutual_in(lists, 1, first, last);
  } else {
    find_mutual_in(lists, lists.stride, first, last);
  }
}

std::size_t find_one_sided(const NearestLists& lists, std::uint32_t first, std::uint32_t last,
                           std::uint32_t owned, const EdgeList& edges) {
  const V all_owned = hn::Set(kNumbers, owned);
  std::size_t found = 0;
  for (std::uint32_t p = first; p < last; ++p) {
    const std::size_t begin = p * lists.stride;
    for (std::size_t line = begin; line < begin + lists.stride; ++line) {
      for (std::size_t place = 0; place < kListLine; place += kLanes<Numbers>) {
        const V q = hn::Load(kNumbers, lists.lines[line].points + place);
        const auto mutual = mask_of(kNumbers, std::uint32_t{lists.mutual[line]} >> place);
        const auto chosen = hn::AndNot(mutual, q < all_owned);
        hn::StoreU(compress(q, chosen), kNumbers, edges.q + found);
        hn::StoreU(hn::Set(kNumbers, p), kNumbers, edges.p + found);
        found += hn::CountTrue(kNumbers, chosen);
      }
    }
  }
  return found;
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lacuna {

HWY_EXPORT(find_mutual);
void find_mutual(const NearestLists& lists, std::uint32_t first, std::uint32_t last) {
  HWY_DYNAMIC_DISPATCH(find_mutual)(lists, first, last);
}

HWY_EXPORT(find_one_sided);
std::size_t find_one_sided(const NearestLists& lists, std::uint32_t first, std::uint32_t last,
                           std::uint32_t owned, const EdgeList& edges) {
  return HWY_DYNAMIC_DISPATCH(find_one_sided)(lists, first, last, owned, edges);
}

}  // namespace lacuna
#endif
