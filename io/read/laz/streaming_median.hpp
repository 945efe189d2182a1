// SPDX-License-Identifier: Apache-2.0
// The middle of five recent values (LAZ, "Streaming median").
#pragma once

#include <array>
#include <cstdint>

namespace lacuna::io::laz {

// Keeps five values in order. A new one takes the place of the largest or of the smallest. It replaces the
// largest until a value comes that is not below the middle, then the smallest until one comes that is not
// above it.
class StreamingMedian {
 public:
  std::int32_t middle() const { return values_[2]; }

  void add(std::int32_t value) {
    const std::int32_t middle = values_[2];
    if (replaces_largest_) {
      std::size_t at = 4;
      for (; at > 0 && value < values_[at - 1]; --at) values_[at] = values_[at - 1];
      values_[at] = value;
      replaces_largest_ = value < middle;
    } else {
      std::size_t at = 0;
      for (; at < 4 && values_[at + 1] < value; ++at) values_[at] = values_[at + 1];
      values_[at] = value;
      replaces_largest_ = value <= middle;
    }
  }

 private:
  std::array<std::int32_t, 5> values_{};
  bool replaces_largest_ = true;
};

}  // namespace lacuna::io::laz
