// SPDX-License-Identifier: Apache-2.0
#include "io/las/las_crs.hpp"

#include "io/crs/crs_text.hpp"
#include "io/crs/length_unit.hpp"
#include "io/files/little_endian.hpp"

#include <algorithm>

namespace lacuna::io {
namespace {

constexpr std::uint16_t kWellKnownText = 2112, kGeoKeys = 34735;  // numbers of records
// Keys of GeoTIFF.
constexpr std::uint16_t kModel = 1024, kGeographic = 2048, kProjected = 3072, kVertical = 4096,
                        kLinearUnit = 3076;
constexpr std::uint16_t kModelProjected = 1, kModelGeographic = 2;  // values of kModel
constexpr std::uint16_t kUserDefined = 32767;                       // codes from here on are not EPSG's

}  // namespace

void LasCrs::take(std::uint16_t record, std::span<const std::byte> data) {
  if (record == kGeoKeys) take_keys(data);
  if (record != kWellKnownText) return;
  const auto* const first = reinterpret_cast<const char*>(data.data());
  well_known_text_.assign(first, std::find(first, first + data.size(), '\0'));
}

// A key has four numbers of 16 bits: the key, where its value is (0: here), a count, the value.
void LasCrs::take_keys(std::span<const std::byte> data) {
  constexpr std::size_t kEntry = 8;
  for (data = data.subspan(std::min(kEntry, data.size())); data.size() >= kEntry;
       data = data.subspan(kEntry)) {
    const auto key = load<std::uint16_t>(&data[0]), place = load<std::uint16_t>(&data[2]);
    const auto code = load<std::uint16_t>(&data[6]);
    if (place != 0) continue;
    if (key == kModel) model_ = code;
    if (key == kProjected && code != 0) has_projected_ = true;
    if (code >= kUserDefined) continue;
    if (key == kGeographic) geographic_ = code;
    if (key == kProjected) projected_ = code;
    if (key == kVertical) vertical_ = code;
    if (key == kLinearUnit) unit_ = code;
  }
}

bool LasCrs::is_projected() const {
  return projected_ != 0 || (model_ == 0 ? has_projected_ : model_ == kModelProjected);
}

std::string LasCrs::text() const {
  if (!well_known_text_.empty()) return well_known_text_;
  // Positions are not in the geographic system below a projected one.
  const std::uint16_t horizontal = is_projected() ? projected_ : geographic_;
  if (horizontal == 0) return "";
  const std::string code = "EPSG:" + std::to_string(horizontal);
  return vertical_ != 0 ? code + "+" + std::to_string(vertical_) : code;
}

bool LasCrs::is_geographic() const {
  if (!well_known_text_.empty()) return io::is_geographic(well_known_text_);
  return !is_projected() && (model_ == kModelGeographic || (model_ == 0 && geographic_ != 0));
}

std::string LasCrs::length_unit() const {
  if (!well_known_text_.empty()) return io::length_unit(well_known_text_);
  constexpr std::uint16_t kMetre = 9001, kFoot = 9002, kSurveyFoot = 9003;  // EPSG
  return unit_ == kMetre ? "m" : unit_ == kFoot ? "ft" : unit_ == kSurveyFoot ? "us-ft" : "";
}

}  // namespace lacuna::io
