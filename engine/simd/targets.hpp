// SPDX-License-Identifier: Apache-2.0
// The instruction sets that kernels are compiled for: targets of Google Highway. Comes before its headers.
//
// A kernel is a source that includes itself once for each target (HWY_TARGET_INCLUDE, foreach_target.h); the
// headers *-inl.hpp belong to the target that includes them. The program chooses the best target that the
// machine has when it first calls a kernel (HWY_DYNAMIC_DISPATCH). Every target computes the same bytes.
// There is no fused multiply-add (no MulAdd, and -ffp-contract=off) and no approximation
// (ApproximateReciprocal). Min and Max never decide between numbers that are not ordered.
#pragma once

// Some targets are left out: they add little to a neighbour in the list, or their vectors' size is not known
// at compile time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
