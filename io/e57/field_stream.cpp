// SPDX-License-Identifier: Apache-2.0
#include "io/e57/field_stream.hpp"

#include "io/files/little_endian.hpp"

#include <cassert>
#include <cstring>

namespace lacuna::io {
namespace {

constexpr std::size_t kPadding = 8;

// Returns `bits` bits, 1 to 64, from any bit on. Loads up to 9 bytes.
std::uint64_t bits_at(const std::byte* bytes, std::uint64_t first, unsigned bits) {
  const std::byte* const at = bytes + first / 8;
  const unsigned shift = first % 8;
  std::uint64_t value = load<std::uint64_t>(at) >> shift;
  if (shift + bits > 64) value |= std::to_integer<std::uint64_t>(at[8]) << (64 - shift);
  return value & ~std::uint64_t{0} >> (64 - bits);
}

// Stores a value for each of `count` rows, by its rank.
template <class ValueOf>
void fill(Column to, std::size_t count, const ValueOf& value_of) {
  with_type(to.type, [&](auto zero) {
    for (std::size_t i = 0; i < count; ++i) {
      store(to.data + i * to.stride, static_cast<decltype(zero)>(value_of(i)));
    }
  });
}

}  // namespace

std::size_t FieldStream::ready(std::size_t most) const {
  if (field_.bits == 0) return most;
  return static_cast<std::size_t>(std::min<std::uint64_t>(most, held_bits() / field_.bits));
}

void FieldStream::append(std::span<const std::byte> bytes) {
  if (field_.bits == 0) return;  // nothing takes them
  const auto taken = static_cast<std::size_t>(begin_bit_ / 8);
  const std::size_t kept = end_ - taken;
  if (taken >= kept) {  // so that each byte is moved once on average
    if (kept > 0) std::memmove(bytes_.data(), bytes_.data() + taken, kept);
    begin_bit_ %= 8;
    end_ = kept;
  }
  bytes_.resize(std::max(bytes_.size(), end_ + bytes.size() + kPadding));
  if (!bytes.empty()) std::memcpy(bytes_.data() + end_, bytes.data(), bytes.size());
  end_ += bytes.size();
}

void FieldStream::take(std::size_t count, Column to, std::int64_t added) {
  assert(ready(count) == count);
  const std::byte* const bytes = bytes_.data();
  const auto whole = [&](std::size_t i) {
    const std::uint64_t stored =
        field_.bits == 0 ? 0 : bits_at(bytes, begin_bit_ + i * field_.bits, field_.bits);
    // Unsigned sums cannot overflow, whatever the limits are.
    return static_cast<std::int64_t>(stored + static_cast<std::uint64_t>(field_.minimum) +
                                     static_cast<std::uint64_t>(added));
  };
  switch (field_.type) {
    case E57Field::Type::kFloat32:
      fill(to, count, [&](std::size_t i) { return load<float>(bytes + begin_bit_ / 8 + i * sizeof(float)); });
      break;
    case E57Field::Type::kFloat64:
      fill(to, count,
           [&](std::size_t i) { return load<double>(bytes + begin_bit_ / 8 + i * sizeof(double)); });
      break;
    case E57Field::Type::kInteger:
      fill(to, count, whole);
      break;
    case E57Field::Type::kScaledInteger:
      fill(to, count,
           [&](std::size_t i) { return static_cast<double>(whole(i)) * field_.scale + field_.offset; });
      break;
  }
  begin_bit_ += count * std::uint64_t{field_.bits};
}

}  // namespace lacuna::io
