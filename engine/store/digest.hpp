// SPDX-License-Identifier: Apache-2.0
// Fingerprints: short numbers that are equal only where the bytes are.
#pragma once

#include "engine/store/store_file.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace lacuna {

// XXH3 of 128 bits (Collet). It covers what a part was made from, or its bytes.
using Digest = std::array<std::uint64_t, 2>;
class Hash {
 public:
  Hash();
  ~Hash();
  void add(std::span<const std::byte> bytes);
  Digest digest() const;  // of all that was added

 private:
  struct State;
  std::unique_ptr<State> state_;
};
Digest digest_of(std::span<const std::byte> bytes);
Digest digest_of(std::string_view text);
Digest digest_of(const StoreFile& file, std::uint64_t offset, std::uint64_t bytes);  // of these bytes of it

}  // namespace lacuna
