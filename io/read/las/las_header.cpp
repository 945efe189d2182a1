// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_header.hpp"

#include "io/read/files/little_endian.hpp"
#include "io/read/las/las_extra.hpp"
#include "io/read/las/las_records.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

namespace lacuna::io {
namespace {

constexpr std::size_t kHead = 60;  // of an extended record

// Sizes by point format.
constexpr std::array<std::size_t, 11> kPointBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::array<std::size_t, 6> kHeaderBytes = {227, 227, 227, 235, 375, 393};  // by minor version
constexpr std::size_t kRecordHeader = 54, kExtraDescriptor = 192;

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
  std::array<std::byte, kRecordHeader> head;
  const std::uint64_t place = in.position();
  in.read(head.data(), head.size());
  const std::string user = text_at(head, 2, 16);
  const auto number = value_at<std::uint16_t>(head, 18), bytes = value_at<std::uint16_t>(head, 20);
  if (in.position() + bytes > header.points_at)
    in.fail_at_byte(place, "a variable length record goes on beyond the first point");
  header.records.push_back({user, number, place, kRecordHeader + bytes});
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

// Finds waveforms within the file: LAS 1.3 has their record behind the points, and no count of such records.
void find_waveforms(const std::filesystem::path& file, std::uint64_t place, LasHeader& header) {
  constexpr std::uint16_t kIsInside = 2;
  if ((value_at<std::uint16_t>(header.bytes, 6) & kIsInside) == 0 || place == 0) return;
  const auto found = std::find_if(header.extended.begin(), header.extended.end(),
                                  [&](const LasRecordExtent& record) { return record.at == place; });
  if (found != header.extended.end()) {
    header.waveforms_at = place;
    return;
  }
  InputFile in(file, kHead);
  if (place > in.remaining() || in.remaining() - place < kHead) return;
  in.skip(place);
  std::array<std::byte, kHead> head;
  in.read(head.data(), head.size());
  const auto bytes = value_at<std::uint64_t>(head, 20);
  if (bytes > in.remaining()) return;
  header.waveforms_at = place;
  header.extended.push_back({text_at(head, 2, 16), value_at<std::uint16_t>(head, 18), place, kHead + bytes});
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
  std::vector<std::byte> head(kHeaderBytes[0]);
  in.read(head.data(), head.size());
  LasHeader header;
  const auto major = value_at<std::uint8_t>(head, 24), minor = value_at<std::uint8_t>(head, 25);
  if (major != 1 || minor > 5) {
    in.fail_at_byte(
        24, "LAS " + std::to_string(major) + "." + std::to_string(minor) + "; versions 1.0 to 1.5 are read");
  }
  header.minor = minor;
  const auto header_bytes = value_at<std::uint16_t>(head, 94);
  if (header_bytes < kHeaderBytes[minor]) {
    in.fail_at_byte(94, "a header of " + std::to_string(header_bytes) + " bytes; LAS 1." +
                            std::to_string(minor) + " has " + std::to_string(kHeaderBytes[minor]) +
                            " or more");
  }
  head.resize(header_bytes);
  in.read(head.data() + kHeaderBytes[0], head.size() - kHeaderBytes[0]);
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
    if (in.position() + kRecordHeader > header.points_at)
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
  if (minor >= 3) find_waveforms(in.file(), value_at<std::uint64_t>(head, 227), header);
  in.skip(header.points_at - in.position());
  return header;
}

}  // namespace lacuna::io
