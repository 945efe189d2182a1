// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_header.hpp"

#include "io/read/crs/crs.hpp"
#include "io/read/rows/columns.hpp"

#include <cmath>
#include <cstring>
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
  const std::string code = code_of_keys(), flat_code = without_vertical(code);
  if (code.empty() || well_known_text_.empty()) return;
  const CrsFacts& of_text = facts_of(well_known_text_);
  if (!of_text.has_positions || flat_code == of_text.code || is_same_crs(flat_code, of_text.horizontal))
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
  if (has_text()) return facts_of(well_known_text_).is_geographic;
  return !is_projected() && (model_ == kModelGeographic || (model_ == 0 && geographic_ != 0));
}

std::string LasCrs::unit_of_keys() const {
  if (unit_ == 0 && unit_size_ < doubles_.size()) return unit_of_metres(doubles_[unit_size_]);
  return unit_ == 0 && is_geocentric() ? "m" : unit_of_code(unit_);
}

std::string LasCrs::length_unit() const {
  const std::string of_text = has_text() ? io::length_unit(well_known_text_) : "";
  return of_text.empty() ? unit_of_keys() : of_text;
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

void put_extra_text(LasExtraBytes& extra, std::size_t at, std::string_view text) {
  std::fill_n(extra.descriptor.begin() + static_cast<std::ptrdiff_t>(at), kText, std::byte{0});
  std::memcpy(&extra.descriptor[at], text.data(), std::min(text.size(), kText));
}

void rename(LasExtraBytes& extra, std::string_view name) {
  extra.name = name.substr(0, kText);
  put_extra_text(extra, kNameAt, extra.name);
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
  const double value = load_las_value(is_floating ? kDoubleType
                                      : is_signed ? kInt64Type
                                                  : kUint64Type,
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
  put_extra_text(extra, kDescriptionAt, description);
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

std::string las_record_head(std::string_view user, std::uint16_t number, std::uint16_t bytes,
                            std::string_view description) {
  std::string head(kLasRecordHead, '\0');
  put_text(head, 2, 16, user);
  put_at(head, 18, number);
  put_at(head, 20, bytes);
  put_text(head, 22, 32, description);
  return head;
}

std::uint64_t copy_las_record(const std::filesystem::path& file, const LasRecordExtent& record,
                              OutputFile& out) {
  constexpr std::size_t kBuffer = std::size_t{1} << 16;
  InputFile in(file, kBuffer);
  in.skip(std::min(record.at, in.remaining()));
  std::vector<std::byte> bytes(kBuffer);
  for (std::uint64_t left = record.bytes; left > 0;) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left, kBuffer));
    in.read(bytes.data(), count);
    out.write(std::span(bytes).first(count));
    left -= count;
  }
  return record.bytes;
}

namespace {

constexpr std::size_t kHead = 60;  // of an extended record

// Sizes by point format.
constexpr std::array<std::size_t, 11> kPointBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::size_t kExtraDescriptor = 192;

template <class T>
T value_at(std::span<const std::byte> bytes, std::size_t offset) {
  return load<T>(&bytes[offset]);
}

// Returns the text up to the first zero.
std::string text_at(std::span<const std::byte> bytes, std::size_t offset, std::size_t length) {
  const auto* const first = reinterpret_cast<const char*>(&bytes[offset]);
  return {first, std::find(first, first + length, '\0')};
}

std::vector<LasExtraBytes> extra_bytes_of(std::span<const std::byte> data) {
  constexpr std::uint8_t kHasScale = 8, kHasOffset = 16;
  std::vector<LasExtraBytes> all;
  for (; data.size() >= kExtraDescriptor; data = data.subspan(kExtraDescriptor)) {
    LasExtraBytes extra{.name = text_at(data, 4, 32),
                        .type = value_at<std::uint8_t>(data, 2),
                        .options = value_at<std::uint8_t>(data, 3),
                        .scale = 1,
                        .offset = 0};
    if (extra.type != 0 && (extra.options & kHasScale) != 0) extra.scale = value_at<double>(data, 112);
    if (extra.type != 0 && (extra.options & kHasOffset) != 0) extra.offset = value_at<double>(data, 136);
    std::copy_n(data.begin(), kExtraDescriptor, extra.descriptor.begin());
    all.push_back(std::move(extra));
  }
  return all;
}

constexpr std::string_view kProjection = "LASF_Projection";

bool is_extra_bytes(std::string_view user, std::uint16_t number) {
  return user == "LASF_Spec" && number == 4;
}

// The header while its records are read.
struct Reading {
  LasHeader& header;
  std::vector<std::vector<LasExtraBytes>> extra{};  // of each record of them that is no copy of another

  void take_extra(std::span<const std::byte> data) {
    std::vector<LasExtraBytes> more = extra_bytes_of(data);
    const auto is_copy = [&](const std::vector<LasExtraBytes>& other) {
      return std::ranges::equal(more, other, {}, &LasExtraBytes::descriptor, &LasExtraBytes::descriptor);
    };
    if (std::ranges::none_of(extra, is_copy)) extra.push_back(std::move(more));
  }

  // One record is allowed, but programs add values by a second one.
  void join_extra() {
    std::size_t bytes = 0;
    for (const auto& record : extra) {
      for (const LasExtraBytes& one : record) bytes += las_extra_size(one);
    }
    const bool fit = bytes + las_point_bytes(header.point_format) <= header.record_bytes;
    if (!fit && extra.size() > 1) {
      header.extra_records = extra.size();
      extra.erase(extra.begin(), extra.end() - 1);
    }
    for (const auto& record : extra)
      header.extra_bytes.insert(header.extra_bytes.end(), record.begin(), record.end());
  }
};

// Reads a variable length record. Records of other users and numbers are passed over.
void read_record(InputFile& in, Reading& reading) {
  LasHeader& header = reading.header;
  std::array<std::byte, kLasRecordHead> head;
  const std::uint64_t place = in.position();
  in.read(head.data(), head.size());
  const std::string user = text_at(head, 2, 16);
  const auto number = value_at<std::uint16_t>(head, 18), bytes = value_at<std::uint16_t>(head, 20);
  if (in.position() + bytes > header.points_at)
    in.fail_at_byte(place, "a variable length record goes on beyond the first point");
  header.records.push_back({user, number, place, kLasRecordHead + bytes});
  std::vector<std::byte> data(bytes);
  in.read(data.data(), data.size());
  if (is_extra_bytes(user, number)) reading.take_extra(data);
  if (user == kProjection) header.crs.take(number, data);
  if (user == kLaszip && number == kLaszipLayout) header.laszip = std::move(data);
}

// Reads the records of LAS 1.4 behind the points: `count` of them, the first at byte `place`.
void read_extended_records(const std::filesystem::path& file, std::uint64_t place, std::uint32_t count,
                           Reading& reading) {
  LasHeader& header = reading.header;
  constexpr std::uint64_t kLongestText = 1 << 20;
  InputFile in(file, kHead);
  in.skip(std::min(place, in.remaining()));
  for (std::uint32_t i = 0; i < count; ++i) {
    std::array<std::byte, kHead> head;
    in.read(head.data(), head.size());
    const auto number = value_at<std::uint16_t>(head, 18);
    const auto bytes = value_at<std::uint64_t>(head, 20);
    if (bytes > in.remaining())
      in.fail_at_byte(in.position() - kHead, "an extended record of " + std::to_string(bytes) +
                                                 " bytes goes on beyond the end of the file");
    const std::string user = text_at(head, 2, 16);
    header.extended.push_back({user, number, in.position() - kHead, kHead + bytes});
    const bool is_extra = is_extra_bytes(user, number);
    if ((user != kProjection && !is_extra) || bytes > kLongestText) {
      in.skip(bytes);
      continue;
    }
    std::vector<std::byte> data(bytes);
    in.read(data.data(), data.size());
    if (is_extra) {
      reading.take_extra(data);
    } else {
      header.crs.take(number, data);
    }
  }
}

void check_points(const InputFile& in, const LasHeader& header) {
  const std::string format = std::to_string(header.point_format);
  if (header.record_bytes < las_point_bytes(header.point_format)) {
    in.fail_at_byte(105, "points of " + std::to_string(header.record_bytes) + " bytes; those of format " +
                             format + " have " + std::to_string(las_point_bytes(header.point_format)) +
                             " or more");
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(std::isfinite(header.scale[axis]) && header.scale[axis] != 0 && std::isfinite(header.offset[axis])))
      in.fail_at_byte(131,
                      "a scale that is 0, or a scale or offset that is not finite; coordinates need both");
  }
}

}  // namespace

std::size_t las_point_bytes(int point_format) {
  return kPointBytes.at(static_cast<std::size_t>(point_format));
}

LasHeader read_las_header(InputFile& in) {
  std::vector<std::byte> head(kLasHeaderBytes[0]);
  in.read(head.data(), head.size());
  LasHeader header;
  const auto major = value_at<std::uint8_t>(head, 24), minor = value_at<std::uint8_t>(head, 25);
  if (major != 1 || minor > 5) {
    in.fail_at_byte(
        24, "LAS " + std::to_string(major) + "." + std::to_string(minor) + "; versions 1.0 to 1.5 are read");
  }
  header.minor = minor;
  const auto header_bytes = value_at<std::uint16_t>(head, 94);
  if (header_bytes < kLasHeaderBytes[minor]) {
    in.fail_at_byte(94, "a header of " + std::to_string(header_bytes) + " bytes; LAS 1." +
                            std::to_string(minor) + " has " + std::to_string(kLasHeaderBytes[minor]) +
                            " or more");
  }
  head.resize(header_bytes);
  in.read(head.data() + kLasHeaderBytes[0], head.size() - kLasHeaderBytes[0]);
  header.bytes = head;

  // The upper two bits of the format say that LASzip has compressed the points.
  const auto format = value_at<std::uint8_t>(head, 104);
  header.is_compressed = (format & 0xc0) != 0;
  header.point_format = format & 0x3f;
  if (header.point_format >= static_cast<int>(kPointBytes.size()))
    in.fail_at_byte(104,
                    "point format " + std::to_string(header.point_format) + "; formats 0 to 10 are read");
  header.points_at = value_at<std::uint32_t>(head, 96);
  header.record_bytes = value_at<std::uint16_t>(head, 105);
  header.points = value_at<std::uint32_t>(head, 107);
  if (minor >= 4 && value_at<std::uint64_t>(head, 247) != 0)
    header.points = value_at<std::uint64_t>(head, 247);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    header.scale[axis] = value_at<double>(head, 131 + 8 * axis);
    header.offset[axis] = value_at<double>(head, 155 + 8 * axis);
  }
  check_points(in, header);

  if (header.points_at < header_bytes) in.fail_at_byte(96, "the points begin within the header");
  Reading reading{.header = header};
  const auto records = value_at<std::uint32_t>(head, 100);
  for (std::uint32_t i = 0; i < records; ++i) {
    if (in.position() + kLasRecordHead > header.points_at)
      in.fail_at_byte(100,
                      std::to_string(records) + " variable length records do not fit before the first point");
    read_record(in, reading);
  }
  if (minor >= 4)
    read_extended_records(in.file(), value_at<std::uint64_t>(head, 235), value_at<std::uint32_t>(head, 243),
                          reading);
  constexpr std::uint16_t kTextBit = 16;  // of the global encoding, reserved before LAS 1.4
  reading.join_extra();
  header.crs.choose((value_at<std::uint16_t>(head, 6) & kTextBit) != 0);
  in.skip(header.points_at - in.position());
  return header;
}

}  // namespace lacuna::io
