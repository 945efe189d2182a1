// SPDX-License-Identifier: Apache-2.0
#include "engine/store/digest.hpp"

#include <algorithm>
#include <vector>

#define XXH_INLINE_ALL  // no library to link
#include <xxhash.h>

namespace lacuna {

struct Hash::State {
  XXH3_state_t hash;
};

Hash::Hash() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->hash);
}

Hash::~Hash() = default;

void Hash::add(std::span<const std::byte> bytes) {
  XXH3_128bits_update(&state_->hash, bytes.data(), bytes.size());
}

Digest Hash::digest() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(&state_->hash);
  return {hash.low64, hash.high64};
}

Digest digest_of(std::span<const std::byte> bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.digest();
}

Digest digest_of(std::string_view text) {
  return digest_of(std::as_bytes(std::span(text)));
}

Digest digest_of(const StoreFile& file, std::uint64_t offset, std::uint64_t bytes) {
  constexpr std::uint64_t kBlock = 1 << 16;  // in the cache
  std::vector<std::byte> block(std::min(kBlock, bytes));
  Hash hash;
  while (bytes > 0) {
    const auto part = std::span(block).first(std::min(kBlock, bytes));
    file.read(offset, part);
    hash.add(part);
    offset += part.size();
    bytes -= part.size();
  }
  return hash.digest();
}

}  // namespace lacuna
