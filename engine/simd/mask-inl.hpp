// SPDX-License-Identifier: Apache-2.0
// Masks: as bits of a number, bit i for lane i, and the numbers of chosen lanes, one after the other.
#if defined(LACUNA_SIMD_MASK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_SIMD_MASK_INL
#undef LACUNA_SIMD_MASK_INL
#else
#define LACUNA_SIMD_MASK_INL
#endif

#include "engine/simd/vector-inl.hpp"

#include <cstdint>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

// As many bits as Highway stores for a mask: at most 16 lanes.
template <class D>
using StoredBits = std::conditional_t<(kLanes<D> > 8), std::uint16_t, std::uint8_t>;

template <class D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask) {
  StoredBits<D> bits;
  hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&bits));
  return bits;
}

// Highway reads eight bytes, whatever the lanes.
template <class D>
HWY_INLINE hn::Mask<D> mask_of(D d, std::uint32_t bits) {
  const std::uint64_t read = bits;
  return hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&read));
}

// Highway 1.0.3 does one thing badly with GCC. Without AVX-512, each call of its Compress copies the table of
// shuffles (1 KiB) to the stack, which makes the search eight times slower. Here the table is static.
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
