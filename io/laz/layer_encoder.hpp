// SPDX-License-Identifier: Apache-2.0
// A layer of a chunk of point formats 6 to 8 that is being written (LAZ, compressor 3).
#pragma once

#include "io/laz/arithmetic_encoder.hpp"

#include <cstddef>
#include <vector>

namespace lacuna::io::laz {

struct LayerEncoder {
  ArithmeticEncoder encoder;
  bool has_changes = false;  // any point has another value than the one before it in its channel

  void note(bool is_changed) { has_changes = has_changes || is_changed; }

  // Nothing where the attribute is the first point's for all points. Nothing can be encoded afterwards.
  std::vector<std::byte> finish() { return has_changes ? encoder.finish() : std::vector<std::byte>(); }
};

}  // namespace lacuna::io::laz
