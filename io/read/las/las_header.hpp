// SPDX-License-Identifier: Apache-2.0
// The header of a LAS file, versions 1.0 to 1.5: the public header block, and what its variable length
// records say. They name the coordinate reference system, extra bytes of points, and the layout of
// compressed points. Source: ASPRS LAS specification 1.4 R15, sections 2.4 to 2.7; GeoTIFF 1.1, 7.2 and
// annex B.
#pragma once

#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

// The coordinate reference system that records of a LAS file name (LAS specification 1.4 R15, 2.5;
// GeoTIFF 1.1, 7.2 and annex B). It takes what the records "LASF_Projection" say, in any order. Well-known
// text holds if the record has it, else the GeoTIFF keys.
class LasCrs {
 public:
  void take(std::uint16_t record, std::span<const std::byte> data);
  // After all records: where text and keys name two systems, the header's bit of well-known text decides.
  void choose(bool has_text_bit);
  // Returns well-known text, or "EPSG:N" of the keys, with a vertical system "EPSG:N+M". Returns an empty
  // text if the file has neither.
  std::string text() const;
  // Returns the other one of two systems; empty if the file names one.
  const std::string& other_text() const { return other_; }
  // Whether positions are longitude and latitude.
  bool is_geographic() const;
  // Returns "m", "ft", "us-ft"; empty if the unit is not known (io/read/crs/crs.hpp).
  std::string length_unit() const;
  // Returns the unit of what does not hold, if it is another one; else nothing.
  std::string other_unit() const;
  // Returns the unit of z likewise.
  std::string vertical_unit() const;

 private:
  void take_keys(std::span<const std::byte> data);
  bool has_text() const { return !well_known_text_.empty() && !do_keys_hold_; }
  std::string code_of_keys() const;
  bool is_projected() const;   // of the keys
  bool is_geocentric() const;  // likewise
  std::string unit_of_keys() const;

  std::string well_known_text_, other_;
  bool do_keys_hold_ = false;  // over well-known text
  // Codes of EPSG; 0 if absent.
  std::uint16_t geographic_ = 0, projected_ = 0, vertical_ = 0, unit_ = 0, vertical_unit_ = 0;
  std::vector<double> doubles_;                                      // to which keys refer
  std::size_t unit_size_ = std::numeric_limits<std::size_t>::max();  // the unit in metres, one of them
  std::uint16_t model_ = 0;                                          // 0: not stated
  bool has_projected_ = false;                                       // with a code or without
};

// A descriptor of the record "Extra Bytes": what a few more bytes of each point are.
struct LasExtraBytes {
  std::string name;
  std::uint8_t type;     // 1 to 10: one value; 11 to 30: two or three values; 0: bytes without a type
  std::uint8_t options;  // of type 0 the number of bytes, else which of the following count
  double scale, offset;  // value = stored * scale + offset
  std::array<std::byte, 192> descriptor{};  // as it is in the record
};

// The place of a variable length record in its file, of either kind.
struct LasRecordExtent {
  std::string user;
  std::uint16_t number;
  std::uint64_t at;     // of its own header
  std::uint64_t bytes;  // with that header
};

struct LasHeader {
  int minor = 0;         // of version 1.x
  int point_format = 0;  // 0 to 10
  bool is_compressed = false;
  std::uint32_t points_at = 0;     // byte of the first point
  std::uint16_t record_bytes = 0;  // of a point
  std::uint64_t points = 0;
  std::array<double, 3> scale{}, offset{};
  std::vector<LasExtraBytes> extra_bytes;  // of all records of them; of the last where they do not fit
  std::uint64_t extra_records = 0;         // that do not fit a point together; else 0
  std::vector<std::byte> laszip;           // data of the record "laszip encoded"; empty without it
  LasCrs crs;
  std::vector<std::byte> bytes;  // the whole header block, as it is in the file
  std::vector<LasRecordExtent> records, extended;
};

// The bytes of the public header block, by minor version.
inline constexpr std::array<std::size_t, 6> kLasHeaderBytes = {227, 227, 227, 235, 375, 393};

// Returns the bytes of a point in this format, without extra bytes.
std::size_t las_point_bytes(int point_format);

// Reads up to `points_at`; `in` is at the file's beginning. Extended records behind the points are read for
// the coordinate reference system and for extra bytes alone. Throws `Error` where the header contradicts
// itself or the file.
LasHeader read_las_header(InputFile& in);

// Extra bytes: values of points that are no fields of the point format (LAS 1.4 R15, table 24).

// For types 1 to 10: the bytes of a value, and the scalar type that keeps it.
struct LasExtraType {
  std::size_t bytes;
  Scalar kept;
};
const LasExtraType& las_extra_type(std::uint8_t type);

// Returns a stored value of type 1 to 10, without scale and offset.
double load_las_value(std::uint8_t type, const std::byte* from);

// Returns the stored value that means no data, of value `i` of a type of several; empty without one.
std::optional<double> las_no_data(const LasExtraBytes& extra, std::size_t i);

// Returns the bytes in a point: of one, two or three values, or without a type; 0 if the type is not known.
std::size_t las_extra_size(const LasExtraBytes& extra);

// Describes one value for each point. Names and descriptions are cut to 32 bytes.
LasExtraBytes las_extra_of(std::string_view name, Scalar type, std::string_view description);
// Describes 1 to 255 bytes that have no type.
LasExtraBytes las_extra_without_type(std::size_t bytes);

// The descriptions of a run's results begin with this text, so that the next run replaces them.
inline constexpr std::string_view kLacunaDescription = "Lacuna: ";
bool is_lacuna_extra(const LasExtraBytes& extra);

// Returns the extra bytes of each point of a file, in order, with the bytes that its header does not
// describe.
std::vector<LasExtraBytes> las_extra_of_points(const LasHeader& header);

// Variable length records as bytes, of either kind: those before the points and the extended ones behind
// them.

// The user of records that the specification defines.
inline constexpr std::string_view kLasSpecification = "LASF_Spec";
inline constexpr std::uint16_t kLasExtraBytes = 4;
// The user of the record in which LASzip describes how points are compressed.
inline constexpr std::string_view kLaszip = "laszip encoded";
inline constexpr std::uint16_t kLaszipLayout = 22204;
inline constexpr std::size_t kLasRecordHead = 54;  // bytes, of records that are not extended

// The bytes before the data of a record that is not extended.
std::string las_record_head(std::string_view user, std::uint16_t number, std::uint16_t bytes,
                            std::string_view description);

// Copies a record of the file byte for byte. Returns the number of bytes copied. Throws `Error`.
std::uint64_t copy_las_record(const std::filesystem::path& file, const LasRecordExtent& record,
                              OutputFile& out);

// Values and text at fixed places in the bytes of a header or record.

template <class T>
void put_at(std::string& bytes, std::size_t offset, T value) {
  store(reinterpret_cast<std::byte*>(&bytes[offset]), value);
}

template <class T>
T value_at(const std::string& bytes, std::size_t offset) {
  return load<T>(reinterpret_cast<const std::byte*>(&bytes[offset]));
}

// The text is cut to `length`, or filled with zeros.
inline void put_text(std::string& bytes, std::size_t offset, std::size_t length, std::string_view text) {
  text = text.substr(0, length);
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), length, '\0');
  std::copy(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset));
}

}  // namespace lacuna::io
