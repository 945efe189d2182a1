// SPDX-License-Identifier: Apache-2.0
// E57: the points of all scans of a file, moved by their poses. ASTM E2807-11.
//
// An E57 file is a sequence of pages of one size. The last 4 bytes of a page are the CRC-32C of its data,
// highest byte first. Offsets that the file states are physical: they count checksums. Its lengths are
// logical: they do not count them. ASTM E2807-11; libE57Format reads and writes the checksum in this byte
// order.
#pragma once

#include "io/read/files/input_file.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lacuna::io {

// Reads at any place; front to back is fastest. Holds about 256 KiB, or one page where that is more.
class PagedFile {
 public:
  static constexpr std::size_t kChecksumBytes = 4;

  // Throws `Error` unless the file can be opened and has whole pages. `page_bytes`: more than kChecksumBytes.
  PagedFile(const std::filesystem::path& file, std::size_t page_bytes);

  std::uint64_t size() const { return size_; }          // in logical bytes
  std::uint64_t position() const { return position_; }  // logical
  // Moves to a physical offset. Throws `Error`, which names it as `what`, unless it is a byte of data.
  void seek(std::uint64_t physical, const std::string& what);
  // Passes over logical bytes, of which the file must have as many.
  void skip(std::uint64_t count);
  // Reads the next bytes. Throws `Error` if the file ends before, or a page's checksum is wrong.
  void read(std::byte* to, std::size_t count);

  // These throw an `Error` that names the file and the physical byte.
  [[noreturn]] void fail(std::uint64_t logical, const std::string& reason) const;
  [[noreturn]] void fail_physical(std::uint64_t physical, const std::string& reason) const;

 private:
  const std::byte* checked_page(std::uint64_t page);
  void load(std::uint64_t page);

  std::unique_ptr<InputFile> in_;  // at the end of the block
  std::size_t page_bytes_;
  std::size_t data_bytes_;  // of a page, without its checksum
  std::uint64_t pages_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;
  std::vector<std::byte> block_;     // pages of the file
  std::uint64_t block_begin_ = 0;    // their first
  std::uint64_t block_end_ = 0;      // behind their last
  std::uint64_t checked_pages_ = 0;  // the page before this one has the right checksum; 0 before any check
};

// Every record is a row. Rays without a return have no position (NaN): those marked as invalid, and those
// that end at the scanner itself. e57_reader.cpp lists the columns. Images, blobs and bounds are passed
// over.

bool looks_like_e57(const FileStart& start);

// Read front to back in bounded memory: a few MiB, what the scans are, and the batch. Only pages that are
// read have their checksums checked. Flags of packets are ignored, as libE57Format does. Cost: linear. A
// point of three floats takes about 10 ns, half of them for the checksums; a spherical one takes 50 ns.
std::unique_ptr<ScanReader> open_e57(const std::filesystem::path& file, const ReadOptions& options);

// What an E57 file declares: its header, and the XML section that describes its scans. ASTM E2807-11.

// One element of the prototype of a scan's points.
struct E57Field {
  enum class Type : std::uint8_t { kFloat32, kFloat64, kInteger, kScaledInteger };
  std::string name;  // as in the file, with the prefix of its extension
  Type type = Type::kFloat64;
  unsigned bits = 64;            // of a value; 0: each is the minimum
  std::int64_t minimum = 0;      // of integers, which are stored less this
  double scale = 1, offset = 0;  // a scaled integer i stands for i * scale + offset

  bool operator==(const E57Field&) const = default;
};

// An entry of data3D.
struct E57Scan {
  std::uint64_t points_at = 0;  // physical offset of the section of its points; 0: none
  std::uint64_t records = 0;
  std::vector<E57Field> fields;  // in the order of their bytestreams; none where there are no records
  Pose pose = Pose::Identity();
  bool has_pose = false;           // the file states it
  bool has_zero_rotation = false;  // its quaternion is 0 0 0 0, taken for no rotation
};

struct E57Header {
  std::size_t page_bytes = 0;
  std::string coordinate_metadata;  // the coordinate system as WKT; empty: not stated
  std::vector<E57Scan> scans;
};

// Throws `Error` unless the version is 1.0, the sizes hold and the scans can be read. The number of records
// of a scan is no more than the file could hold, where a record of no bits counts as one bit. All scans
// together have at most 64 values for each byte of the file.
// Memory: up to 17 times the XML section, which may have up to 16 MiB and be no larger than the file.
E57Header read_e57_header(const std::filesystem::path& file);

// Reads the scans and coordinate metadata of an XML section of `bytes` logical bytes at the position of
// `pages`.
void read_e57_xml(PagedFile& pages, std::size_t bytes, E57Header& header);

// The points of one E57 scan, front to back.
//
// Its section begins with 32 bytes: a 1, 7 bytes of zero, the section's length, the offsets of its data and
// of its index. Packets follow. Each begins with its type, flags and its length less 1, in 1, 1 and 2 bytes.
// A data packet, type 1, has the number of fields in 2 bytes, the length of each field's part in 2 bytes, and
// the parts. Packets of an index, type 0, and empty ones, type 2, are passed over. ASTM E2807-11.

// The bytes of one field of a scan, as its packets bring them, and the values that they hold.
//
// Values follow each other bit by bit, from the lowest bit of a byte on, without regard to bytes or packets.
// An integer is stored less its minimum, in as many bits as its maximum needs. ASTM E2807-11, bitPackCodec.
class FieldStream {
 public:
  explicit FieldStream(E57Field field) : field_(std::move(field)) {}

  // Returns the number of values that can be taken, at most `most`.
  std::size_t ready(std::size_t most) const;
  // Whether more bits are held than padding explains. libE57Format pads integers to words of
  // 8 to 64 bits, other programs to bytes.
  bool holds_more() const { return held_bits() >= std::max(8U, std::bit_ceil(field_.bits)); }
  std::size_t held_bytes() const { return static_cast<std::size_t>(held_bits() / 8); }

  // Adds bytes behind the bytes held. Cost: linear, whatever is held.
  void append(std::span<const std::byte> bytes);
  // Takes the next `count` values, which must be ready. `to` has a type that holds them; integers of more
  // than 32 bits and scaled integers become doubles. `added` is added to integers.
  void take(std::size_t count, Column to, std::int64_t added = 0);

 private:
  std::uint64_t held_bits() const { return end_ * std::uint64_t{8} - begin_bit_; }

  E57Field field_;
  std::vector<std::byte> bytes_;  // with padding, so that a value can be loaded as whole words
  std::size_t end_ = 0;           // of the bytes held
  std::uint64_t begin_bit_ = 0;   // of the next value
};

// Holds one packet, and at most 8 MiB of values that arrive before the values of other fields.
class E57Points {
 public:
  // `number` is the scan's in the file. Throws `Error` unless the section of its points can be read.
  E57Points(PagedFile& pages, const E57Scan& scan, std::size_t number);

  std::uint64_t left() const { return left_; }

  // Returns how many points can be taken, at least 1 and at most `most`, while points are left. Reads packets
  // for them. Throws `Error` if packets are damaged or end too early.
  std::size_t ready(std::size_t most);
  // Copies the values of a field for the next `count` points, which are ready. Call it once for each field,
  // then `pass`.
  void take(std::size_t field, std::size_t count, Column to, std::int64_t added) {
    streams_[field].take(count, to, added);
  }
  void pass(std::size_t count) { left_ -= count; }
  // Throws `Error` if the packets hold more points than the scan declares, and no point is left to be taken.
  // One point of integers alone may be taken for padding.
  void require_end();

 private:
  void read_packet();
  void read_data(std::uint64_t place, std::size_t bytes);
  bool holds_more() const;
  [[noreturn]] void fail_more() const;
  [[noreturn]] void fail(std::uint64_t place, const std::string& reason) const;

  PagedFile& pages_;
  std::size_t number_;
  std::uint64_t records_;
  std::uint64_t left_;
  std::uint64_t end_ = 0;  // of the section, logical
  std::vector<FieldStream> streams_;
  std::vector<std::byte> packet_;
};

// Moves points and normals of an E57 scan from its own coordinates to the coordinates of the file.

// A row begins with three doubles: the position, as it is in the scan.
struct E57Rows {
  std::byte* data;
  std::size_t stride;
  std::size_t count;
};

// Turns range, azimuth and elevation, the angles in radians, into x y z. The position is NaN if an angle is
// not finite or beyond 1e6. Returns the number of rows with an angle beyond a full turn. The bytes are equal
// on every machine. Error: 1e-15 times the range.
std::size_t spherical_to_cartesian(E57Rows rows);

// Moves positions by the pose. A point exactly at the scanner is a ray without a return, and becomes NaN.
void place_points(E57Rows rows, const Pose& pose);

// Turns normals by the pose; the columns are floats or doubles.
void turn_normals(std::array<Column, 3> normals, std::size_t count, const Pose& pose);

// Sets the position of each row with a state other than 0 to NaN: 1 is a direction alone, 2 nothing.
void drop_invalid(E57Rows rows, Column state);

}  // namespace lacuna::io
