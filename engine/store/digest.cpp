// SPDX-License-Identifier: Apache-2.0
#include "engine/store/digest.hpp"

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

}  // namespace lacuna
