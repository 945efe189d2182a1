// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_extra.hpp"

#include "io/read/files/little_endian.hpp"
#include "io/read/rows/scalar.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

namespace lacuna::io {
namespace {

constexpr std::array<LasExtraType, 11> kTypes = {{{0, Scalar::kUint8},
                                                  {1, Scalar::kUint8},
                                                  {1, Scalar::kInt8},
                                                  {2, Scalar::kUint16},
                                                  {2, Scalar::kInt16},
                                                  {4, Scalar::kUint32},
                                                  {4, Scalar::kInt32},
                                                  {8, Scalar::kFloat64},
                                                  {8, Scalar::kFloat64},
                                                  {4, Scalar::kFloat32},
                                                  {8, Scalar::kFloat64}}};
constexpr std::uint8_t kUint64Type = 7, kInt64Type = 8, kFloatType = 9, kDoubleType = 10, kLastType = 30;
constexpr std::size_t kText = 32, kTypeAt = 2, kOptionsAt = 3, kNameAt = 4, kDescriptionAt = 160;

std::uint8_t type_of(Scalar type) {
  switch (type) {
    case Scalar::kUint8:
      return 1;
    case Scalar::kInt8:
      return 2;
    case Scalar::kUint16:
      return 3;
    case Scalar::kInt16:
      return 4;
    case Scalar::kUint32:
      return 5;
    case Scalar::kInt32:
      return 6;
    case Scalar::kFloat32:
      return kFloatType;
    case Scalar::kFloat64:
      break;
  }
  return kDoubleType;
}

void put_text(LasExtraBytes& extra, std::size_t at, std::string_view text) {
  std::fill_n(extra.descriptor.begin() + static_cast<std::ptrdiff_t>(at), kText, std::byte{0});
  std::memcpy(&extra.descriptor[at], text.data(), std::min(text.size(), kText));
}

void rename(LasExtraBytes& extra, std::string_view name) {
  extra.name = name.substr(0, kText);
  put_text(extra, kNameAt, extra.name);
}

// Returns the type of one value, for types of several.
std::uint8_t base_type(const LasExtraBytes& extra) {
  return static_cast<std::uint8_t>((extra.type - 1) % 10 + 1);
}

}  // namespace

const LasExtraType& las_extra_type(std::uint8_t type) {
  return kTypes.at(type);
}

double load_las_value(std::uint8_t type, const std::byte* from) {
  if (type == kUint64Type) return static_cast<double>(load<std::uint64_t>(from));
  if (type == kInt64Type) return static_cast<double>(load<std::int64_t>(from));
  return with_type(kTypes[type].kept,
                   [&](auto zero) { return static_cast<double>(load<decltype(zero)>(from)); });
}

std::optional<double> las_no_data(const LasExtraBytes& extra, std::size_t i) {
  constexpr std::uint8_t kHasNoData = 1;
  constexpr std::size_t kNoDataAt = 40;  // as eight bytes of the kind of the type
  if (extra.type == 0 || extra.type > kLastType || (extra.options & kHasNoData) == 0) return std::nullopt;
  const std::uint8_t type = base_type(extra);
  const bool is_signed = type % 2 == 0, is_floating = type >= kFloatType;
  const double value = load_las_value(is_floating ? kDoubleType : is_signed ? kInt64Type : kUint64Type,
                                      &extra.descriptor[kNoDataAt + sizeof(double) * i]);
  return type == kFloatType ? static_cast<double>(nearest_float(value)) : value;
}

std::size_t las_extra_size(const LasExtraBytes& extra) {
  if (extra.type == 0) return extra.options;
  if (extra.type > kLastType) return 0;
  return kTypes[base_type(extra)].bytes * ((extra.type - 1u) / 10 + 1);
}

LasExtraBytes las_extra_of(std::string_view name, Scalar type, std::string_view description) {
  LasExtraBytes extra{.name = {}, .type = type_of(type), .options = 0, .scale = 1, .offset = 0};
  extra.descriptor[kTypeAt] = static_cast<std::byte>(extra.type);
  rename(extra, name);
  put_text(extra, kDescriptionAt, description);
  return extra;
}

LasExtraBytes las_extra_without_type(std::size_t bytes) {
  LasExtraBytes extra{
      .name = {}, .type = 0, .options = static_cast<std::uint8_t>(bytes), .scale = 1, .offset = 0};
  extra.descriptor[kOptionsAt] = static_cast<std::byte>(bytes);
  rename(extra, bytes == 1 ? "extra_0" : "extra");
  return extra;
}

bool is_lacuna_extra(const LasExtraBytes& extra) {
  const auto text = std::as_bytes(std::span(kLacunaDescription));
  return std::equal(text.begin(), text.end(), extra.descriptor.begin() + kDescriptionAt);
}

std::vector<LasExtraBytes> las_extra_of_points(const LasHeader& header) {
  constexpr std::size_t kMostWithoutType = 255;
  std::vector<LasExtraBytes> all;
  std::size_t left = header.record_bytes - las_point_bytes(header.point_format);
  for (const LasExtraBytes& extra : header.extra_bytes) {
    const std::size_t bytes = las_extra_size(extra);
    if (bytes == 0) continue;
    if (bytes > left) break;
    all.push_back(extra);
    left -= bytes;
  }
  for (; left > 0; left -= std::min(left, kMostWithoutType))
    all.push_back(las_extra_without_type(std::min(left, kMostWithoutType)));
  return all;
}

}  // namespace lacuna::io
