// SPDX-License-Identifier: Apache-2.0
// Masks as bits of a number: bit i for lane i.
#if defined(LACUNA_SIMD_MASK_BITS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_SIMD_MASK_BITS_INL
#undef LACUNA_SIMD_MASK_BITS_INL
#else
#define LACUNA_SIMD_MASK_BITS_INL
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

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
