// SPDX-License-Identifier: Apache-2.0
// Every criterion has its formula, its name, the default of its weight, and the help of its weight here. The
// config, the combined probability, the stored results and the columns of the annotated scan all come from
// this table.
#if defined(LACUNA_CRITERIA_TABLE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_CRITERIA_TABLE_INL
#undef LACUNA_CRITERIA_TABLE_INL
#else
#define LACUNA_CRITERIA_TABLE_INL
#endif

#include "engine/criteria/angle-inl.hpp"
#include "engine/criteria/halfdisc-inl.hpp"
#include "engine/criteria/shape-inl.hpp"
#include "engine/criteria/slice-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

struct CriterionEntry {
  V (*formula)(const Surface<V>&);  // from 0 to 1
  const char* name;
  double default_weight;
  const char* help;
};

constexpr CriterionEntry kTable[] = {
    {angle_probability<V>, "angle", 1, "Share of the angle criterion; weights are divided by their sum."},
    {halfdisc_probability<V>, "halfdisc", 1, "Share of the halfdisc criterion."},
    {shape_probability<V>, "shape", 1, "Share of the shape criterion; more of it for noisy scans."},
};

inline constexpr std::size_t kCriteria = sizeof kTable / sizeof kTable[0];

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
