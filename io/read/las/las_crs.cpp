// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_crs.hpp"

#include "io/read/crs/crs_text.hpp"
#include "io/read/crs/length_unit.hpp"
#include "io/read/crs/stated_crs.hpp"
#include "io/read/files/little_endian.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace lacuna::io {
namespace {

constexpr std::uint16_t kWellKnownText = 2112, kGeoKeys = 34735, kDoubles = 34736;  // numbers of records
// Keys of GeoTIFF.
constexpr std::uint16_t kModel = 1024, kGeographic = 2048, kProjected = 3072, kVertical = 4096,
                        kLinearUnit = 3076, kGeocentricUnit = 2052, kVerticalUnit = 4099, kLinearSize = 3077,
                        kGeocentricSize = 2053;  // of a unit without a code
// Values of kModel.
constexpr std::uint16_t kModelProjected = 1, kModelGeographic = 2, kModelGeocentric = 3;
constexpr std::uint16_t kUserDefined = 32767;  // codes from here on are not EPSG's

// Codes of GeoTIFF 1.0, which EPSG has for datums or not at all: 5103 is the datum of NAVD 88, and no system.
bool is_vertical_code(std::uint16_t code) {
  return code < 5001 || (code > 5033 && code < 5101) || code > 5106;
}

// GeoTIFF names a geocentric system by the geographic one of its datum, which is in degrees. Returns the code
// of the geocentric system; 0 if it is not known.
std::uint16_t geocentric_code(std::uint16_t code) {
  constexpr std::uint16_t kWgs84 = 4978, kEtrs89 = 4936, kNad83 = 6317;
  if (code == 4326 || code == 4979 || code == kWgs84) return kWgs84;
  if (code == 4258 || code == 4937 || code == kEtrs89) return kEtrs89;
  if (code == 6318 || code == 6319 || code == kNad83) return kNad83;
  return 0;
}

std::string unit_of_code(std::uint16_t code) {
  constexpr std::pair<std::uint16_t, const char*> kCodes[] = {
      // of EPSG
      {9001, "m"}, {9036, "km"}, {1033, "cm"}, {1025, "mm"}, {9002, "ft"}, {9003, "us-ft"}, {9096, "yd"}};
  const auto* const found = std::find_if(std::begin(kCodes), std::end(kCodes),
                                         [&](const auto& known) { return known.first == code; });
  return found == std::end(kCodes) ? "" : found->second;
}

}  // namespace

void LasCrs::take(std::uint16_t record, std::span<const std::byte> data) {
  if (record == kGeoKeys) take_keys(data);
  if (record == kDoubles) {
    for (doubles_.clear(); data.size() >= sizeof(double); data = data.subspan(sizeof(double)))
      doubles_.push_back(load<double>(data.data()));
  }
  if (record != kWellKnownText) return;
  const auto* const first = reinterpret_cast<const char*>(data.data());
  well_known_text_.assign(first, std::find(first, first + data.size(), '\0'));
}

// A key has four numbers of 16 bits: the key, where its value is (0: here), a count, the value or its index.
void LasCrs::take_keys(std::span<const std::byte> data) {
  constexpr std::size_t kEntry = 8;
  for (data = data.subspan(std::min(kEntry, data.size())); data.size() >= kEntry;
       data = data.subspan(kEntry)) {
    const auto key = load<std::uint16_t>(&data[0]), place = load<std::uint16_t>(&data[2]);
    const auto code = load<std::uint16_t>(&data[6]);
    if ((key == kLinearSize || key == kGeocentricSize) && place == kDoubles) unit_size_ = code;
    if (place != 0) continue;
    if (key == kModel) model_ = code;
    if (key == kProjected && code != 0) has_projected_ = true;
    if (code >= kUserDefined) continue;
    if (key == kGeographic) geographic_ = code;
    if (key == kProjected) projected_ = code;
    if (key == kVertical && is_vertical_code(code)) vertical_ = code;
    if (key == kLinearUnit || key == kGeocentricUnit) unit_ = code;
    if (key == kVerticalUnit) vertical_unit_ = code;
  }
}

bool LasCrs::is_projected() const {
  return projected_ != 0 || (model_ == 0 ? has_projected_ : model_ == kModelProjected);
}

bool LasCrs::is_geocentric() const {
  return model_ == kModelGeocentric && !is_projected();
}

void LasCrs::choose(bool has_text_bit) {
  const std::string code = code_of_keys(), flat_code(without_vertical(code)),
                    flat_text(horizontal_system(well_known_text_));
  if (code.empty() || flat_text.empty() || flat_code == own_code(flat_text) ||
      is_same_crs(flat_code, flat_text))
    return;
  // A geographic code alone is often what is left of a conversion.
  do_keys_hold_ = !has_text_bit && (is_projected() || is_geocentric());
  other_ = do_keys_hold_ ? well_known_text_ : code;
}

std::string LasCrs::text() const {
  return has_text() ? well_known_text_ : code_of_keys();
}

std::string LasCrs::code_of_keys() const {
  if (is_geocentric()) {
    const std::uint16_t code = geocentric_code(geographic_);
    return code == 0 ? "" : "EPSG:" + std::to_string(code);
  }
  // Positions are not in the geographic system below a projected one.
  const std::uint16_t horizontal = is_projected() ? projected_ : geographic_;
  if (horizontal == 0) return "";
  const std::string code = "EPSG:" + std::to_string(horizontal);
  return vertical_ != 0 ? code + "+" + std::to_string(vertical_) : code;
}

bool LasCrs::is_geographic() const {
  if (has_text()) return io::is_geographic(well_known_text_);
  return !is_projected() && (model_ == kModelGeographic || (model_ == 0 && geographic_ != 0));
}

std::string LasCrs::unit_of_keys() const {
  if (unit_ == 0 && unit_size_ < doubles_.size()) return unit_of_metres(doubles_[unit_size_]);
  return unit_ == 0 && is_geocentric() ? "m" : unit_of_code(unit_);
}

std::string LasCrs::length_unit() const {
  return has_text() ? io::length_unit(well_known_text_) : unit_of_keys();
}

std::string LasCrs::other_unit() const {
  const std::string unit = length_unit(),
                    other = has_text() ? unit_of_keys() : io::length_unit(well_known_text_);
  return unit.empty() || unit == other ? "" : other;
}

std::string LasCrs::vertical_unit() const {
  const std::string of_text = io::vertical_unit(well_known_text_), of_keys = unit_of_code(vertical_unit_);
  return of_text.empty() || (do_keys_hold_ && !of_keys.empty()) ? of_keys : of_text;
}

}  // namespace lacuna::io
