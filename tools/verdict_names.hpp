// SPDX-License-Identifier: Apache-2.0
// The words of `lacuna evaluate` for its decision on a loop, as docs/evaluate.md defines them.
#pragma once

#include "tools/accuracy/match_loops.hpp"

namespace lacuna::tools {

constexpr const char* name_of(accuracy::EdgeDecision verdict) {
  using accuracy::EdgeDecision;
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

}  // namespace lacuna::tools
