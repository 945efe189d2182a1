// SPDX-License-Identifier: Apache-2.0
// The layers of a chunk of point formats 6 to 8: a stream for each attribute (LAZ, compressor 3).
#pragma once

#include "io/read/laz/arithmetic_decoder.hpp"
#include "io/read/laz/arithmetic_encoder.hpp"

#include <cstddef>
#include <optional>
#include <type_traits>
#include <vector>

namespace lacuna::io::laz {

// A layer that is read. It has no stream where the attribute is the first point's for all points.
struct DecodedLayer {
  static constexpr bool kEncodes = false;
  std::optional<ArithmeticDecoder> decoder;

  // Calls code(decoder), which sets `now` to the next point's value. Before, `now` is the last point's.
  template <class Value, class Code>
  void code(const Value& /*last*/, const Value& /*now*/, Code&& code) {
    if (decoder) code(*decoder);
  }
  // Does the same for a layer that always has a stream.
  template <class Code>
  void code(Code&& code) {
    code(*decoder);
  }
};

// A layer that is written.
struct EncodedLayer {
  static constexpr bool kEncodes = true;
  ArithmeticEncoder encoder;
  bool has_changes = false;  // any point has another value than the one before it in its channel

  // Calls code(encoder), which reads `now`.
  template <class Value, class Code>
  void code(const Value& last, const Value& now, Code&& code) {
    has_changes = has_changes || last != now;
    code(encoder);
  }
  template <class Code>
  void code(Code&& code) {
    code(encoder);
  }

  // Nothing where the attribute is the first point's for all points. Nothing can be encoded afterwards.
  std::vector<std::byte> finish() { return has_changes ? encoder.finish() : std::vector<std::byte>(); }
};

// A byte of a record: an encoder only reads it.
template <class Layer>
using ItemByte = std::conditional_t<Layer::kEncodes, const std::byte, std::byte>;

}  // namespace lacuna::io::laz
