// SPDX-License-Identifier: Apache-2.0
// LAS files drawn as bytes, and their points compressed by the encoder of io/read/laz.
#pragma once

#include "io/read/laz/laz.hpp"
#include "tests/support/test.hpp"

namespace lacuna::test {

// Sets the bytes of a value; the file grows where it must.
template <class T>
void put(std::string& bytes, std::size_t offset, T value) {
  if (bytes.size() < offset + sizeof value) bytes.resize(offset + sizeof value);
  std::memcpy(&bytes[offset], &value, sizeof value);
}

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  if (offset + sizeof value > bytes.size()) throw std::out_of_range("a value behind the end");
  std::memcpy(&value, &bytes[offset], sizeof value);
  return value;
}

// A variable length record.
std::string las_record(const std::string& user, std::uint16_t number, const std::string& data);

// An extended one.
std::string las_extended_record(const std::string& user, std::uint16_t number, const std::string& data);

// Appends extended records to a file of LAS 1.4 that has none.
std::string with_extended(std::string bytes, const std::vector<std::string>& records);

// Well-known text that PROJ reads: of a projected system with this unit and maybe a code of EPSG, or of the
// system "GEOGCS" below it.
std::string known_system(const std::string& name, const std::string& unit = "metre\",1", int code = 0);

// The data of the record of GeoTIFF keys: of each its number, its place, its count and its value.
std::string las_geo_keys(const std::vector<std::array<std::uint16_t, 4>>& keys);

// The descriptor of a value in the record "Extra Bytes".
std::string las_extra_descriptor(const std::string& name, std::uint8_t type, std::uint8_t options = 0,
                                 double scale = 0, double offset = 0);

// All zero, but for the coordinates.
std::string las_point(std::size_t bytes, std::int32_t x, std::int32_t y, std::int32_t z);

// Points alike, as in a scan: a few bytes of each differ from the one before.
std::vector<std::string> las_points_alike(std::size_t bytes, std::size_t count);

struct LasFile {
  int minor = 2;
  int format = 0;
  std::vector<std::string> points;   // their records, of one size
  std::vector<std::string> records;  // of variable length
  std::array<double, 3> scale{0.01, 0.01, 0.001}, offset{500'000, 5'400'000, 0};

  std::string bytes() const;
};

// A file of format 0 with a point of each of these classes.
std::string las_of_classes(const std::vector<int>& classes);

// ---- Compressed points

using LazBytes = std::vector<std::byte>;

// The items of a point format, 0 to 3 with version 2, or 6 to 8 with version 3 or 4. `extra_bytes` are behind
// them. `chunk_points`: laz::kVariableChunks writes the number of points of each chunk.
io::laz::Layout laz_layout(int point_format, std::uint16_t extra_bytes, std::uint32_t chunk_points,
                           std::uint16_t version);

// All bytes of a file from its point data at `offset` on: the offset of the chunk table, the chunks, the
// table. `chunk_points` are the points of each chunk, together all of `records`.
LazBytes laz_point_data(const io::laz::Layout& layout, std::span<const std::byte> records,
                        std::span<const std::uint64_t> chunk_points, std::uint64_t offset);

std::string text_of(std::span<const std::byte> bytes);

// What is before the points of a file: its header and records, with that of the layout.
std::string laz_head(LasFile las, const io::laz::Layout& layout);

// The points of a file behind its head, one record after the other.
std::string laz_points(const io::laz::Layout& layout, const std::string& records,
                       const std::vector<std::uint64_t>& chunk_points, std::size_t offset);

std::string laz_file(const LasFile& las, const io::laz::Layout& layout,
                     const std::vector<std::uint64_t>& chunk_points);

}  // namespace lacuna::test
