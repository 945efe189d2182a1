// SPDX-License-Identifier: Apache-2.0
// Kernels run by each of the instruction sets that they are compiled for and that the machine has.
#pragma once

#include "engine/simd/targets.hpp"
#include "tests/support/test.hpp"

#include <hwy/highway.h>

namespace lacuna {

// For its lifetime, kernels are those of one instruction set; 0: the best one.
class InstructionSet {
 public:
  explicit InstructionSet(std::int64_t target) { choose(target); }
  ~InstructionSet() { choose(0); }
  InstructionSet(const InstructionSet&) = delete;

 private:
  static void choose(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

inline std::vector<std::int64_t> instruction_sets() {
  std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  if (targets.back() != HWY_STATIC_TARGET) targets.push_back(HWY_STATIC_TARGET);
  return targets;
}

// visit(): once by each instruction set, the best one first.
template <class Visit>
void by_each_instruction_set(Visit&& visit) {
  for (const std::int64_t target : instruction_sets()) {
    const InstructionSet chosen(target);
    INFO("instruction set " << hwy::TargetName(target));
    visit();
  }
}

}  // namespace lacuna
