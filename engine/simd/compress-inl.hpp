// SPDX-License-Identifier: Apache-2.0
// Returns the numbers of chosen lanes, one after the other.
//
// Highway 1.0.3 does one thing badly with GCC. Without AVX-512, each call of its Compress copies the table of
// shuffles (1 KiB) to the stack, which makes the search eight times slower. Here the table is static.
#if defined(LACUNA_SIMD_COMPRESS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_SIMD_COMPRESS_INL
#undef LACUNA_SIMD_COMPRESS_INL
#else
#define LACUNA_SIMD_COMPRESS_INL
#endif

#include "engine/simd/mask_bits-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_AVX3
template <class V>
HWY_INLINE V compress(V numbers, MaskOf<V> chosen) {
  return hn::Compress(numbers, chosen);
}
#else
// By the bits of the mask: the chosen lanes, in ascending order.
template <std::size_t kNumbers>
struct ChosenLanes {
  alignas(kNumbers) std::uint8_t of[1 << kNumbers][kNumbers];

  consteval ChosenLanes() : of{} {
    for (std::size_t bits = 0; bits < std::size_t{1} << kNumbers; ++bits) {
      std::size_t count = 0;
      for (std::size_t lane = 0; lane < kNumbers; ++lane) {
        if ((bits >> lane & 1) != 0) of[bits][count++] = static_cast<std::uint8_t>(lane);
      }
    }
  }
};
template <std::size_t kNumbers>
inline constexpr ChosenLanes<kNumbers> kChosenLanes;

// The first chosen number fills the lanes beyond the chosen ones.
template <class V>
HWY_INLINE V compress(V numbers, MaskOf<V> chosen) {
  const TagOf<V> d;
  const hn::RebindToUnsigned<TagOf<V> > whole;
  const hn::Rebind<std::uint8_t, TagOf<V> > bytes;
  const auto lanes = hn::Load(bytes, kChosenLanes<kLanes<TagOf<V> > >.of[bits_of(d, chosen)]);
  return hn::TableLookupLanes(numbers, hn::IndicesFromVec(d, hn::PromoteTo(whole, lanes)));
}
#endif

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
