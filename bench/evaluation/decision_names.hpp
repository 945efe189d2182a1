// SPDX-License-Identifier: Apache-2.0
// The words of `lacuna-bench evaluate` for its decision on a loop, as docs/evaluate.md defines them.
#pragma once

#include "tools/matching/match_loops.hpp"

namespace lacuna::evaluation {
using namespace matching;

constexpr const char* name_of(EdgeDecision verdict) {
  switch (verdict) {
    case EdgeDecision::kFound:
      return "found";
    case EdgeDecision::kRepeated:
      return "repeated";
    case EdgeDecision::kShort:
      return "short";
    case EdgeDecision::kJoined:
      return "joined";
    case EdgeDecision::kParted:
      return "parted";
    case EdgeDecision::kStep:
      return "step";
    case EdgeDecision::kUnsampled:
      return "unsampled";
    case EdgeDecision::kFalse:
      break;
  }
  return "false";
}

}  // namespace lacuna::evaluation
