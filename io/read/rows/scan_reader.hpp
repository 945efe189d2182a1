// SPDX-License-Identifier: Apache-2.0
// Rows of scalars: what every format delivers in bounded batches, what each point file is written from, and
// names.
#pragma once

#include "engine/export.hpp"
#include "io/read/rows/pose.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// The names of properties, the same whatever the format they come from.

// Returns the text with A to Z in lower case.
std::string lower_case(std::string_view text);

// Returns the names of position and normal for X Y Z and NX NY NZ, in any mix of cases, and others as they
// are.
std::string known_name(std::string_view given);

// Returns the name as it can be written in a PLY header: blanks and control characters become '_'.
std::string property_name(std::string_view given);

// The names of the properties that make the colour of a point.
inline constexpr const char* kColourNames[] = {"red", "green", "blue", "intensity"};

// Returns one spelling for "return_number", PDAL's "ReturnNumber" and CloudCompare's "scalar_Return_Number":
// without case, blanks and underscores.
std::string bare_name(std::string_view name);

// Reading a scan file: every format delivers rows of scalars in bounded batches.

enum class Scalar : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

LACUNA_API std::size_t size_of(Scalar type);
LACUNA_API const char* ply_name(Scalar type);  // "char", "uchar", ..., "float", "double"

// A scalar of every row, at a fixed byte offset, in the machine's byte order.
struct Property {
  std::string name;
  Scalar type;
  std::size_t offset;
};

// Every reader refuses rows with more columns than this, since it holds the names and types of columns in
// memory.
inline constexpr std::size_t kMostColumns = 10'000;
inline constexpr const char* kTooManyColumns = "more than the 10,000 columns that are read";

struct RowLayout {
  std::vector<Property> properties;  // in file order; lists are skipped
  std::size_t stride = 0;            // bytes per row, no padding

  LACUNA_API const Property* find(std::string_view name) const;  // one after the other
  // Returns the ones whose names are spelled alike (bare_name); the one of
  // this very name alone, if there is one.
  std::vector<const Property*> all_alike(std::string_view name) const;
  // Returns the first of them.
  LACUNA_API const Property* find_alike(std::string_view name) const;
};

struct RowBatch {
  std::size_t count = 0;
  std::vector<std::byte> bytes;  // count * stride
};

// The place of a scanner, as a file states it.
struct ScannerPose {
  Eigen::Vector3d place;
  Eigen::Vector3d axis{0, 0, 1};        // of unit length: the scanner turns around it
  std::optional<std::uint32_t> source;  // the value of its rows in the column `scan`; empty: all rows
};

// What a reader does not read as the user may expect: `count` times `thing`, and what is done with them.
struct ReaderNote {
  std::uint64_t count;  // 0: nothing to say
  std::string thing;    // its plural has an s
  std::string what;
};

// The note that the faces of a mesh are not read.
ReaderNote note_of_faces(std::uint64_t count, const char* thing = "face");

// What a reader finds in rows that its user may not expect, up to the last row that was read.
struct RowFindings {
  std::uint64_t repeated_lines = 0;  // of text, that stand before the rows, too
  std::uint64_t other_places = 0;    // scans whose place is not the place of their pose
  std::uint64_t wide_angles = 0;     // points with an angle beyond a full turn
};
inline constexpr std::uint64_t RowFindings::*kRowFindings[] = {
    &RowFindings::repeated_lines, &RowFindings::other_places, &RowFindings::wide_angles};
LACUNA_API std::vector<ReaderNote> notes_of(const RowFindings& findings);

// The bytes of rows that readers and writers of files hold at a time.
inline constexpr std::size_t kBatchBytes = std::size_t{32} << 20;

// Reads the points of one file, front to back. Every failure is an `Error` that names the file, the place
// (line or byte) and the reason.
class LACUNA_API ScanReader {
 public:
  virtual ~ScanReader() = default;
  virtual std::string format() const = 0;       // "text", or "PLY, ascii" and so on
  virtual const RowLayout& layout() const = 0;  // has x, y and z
  virtual std::optional<std::uint64_t> expected_rows() const = 0;
  // Reads the next rows, at most `max_rows`; false at the end, after the file proved complete.
  virtual bool next(RowBatch& batch, std::size_t max_rows) = 0;
  // Whether the reader is slower than a file of plain numbers, so that a program that reads twice had better
  // keep the rows.
  virtual bool is_slow() const { return false; }
  // Returns the coordinate reference system, as well-known text or a code such as "EPSG:25832"; empty if not
  // known.
  virtual std::string crs() const { return {}; }
  // Returns another system that the file names as well; empty: it names one at most.
  virtual std::string other_crs() const { return {}; }
  // Whether positions are longitude and latitude.
  virtual bool is_geographic() const;
  // Returns the unit of length, as unit_of_metres (io/read/crs/crs.hpp); empty if not known.
  virtual std::string length_unit() const;
  // Returns another unit of length that the file states as well; empty: none contradicts.
  virtual std::string other_unit() const { return {}; }
  // Returns the unit of z likewise; empty if not known, and then it is the unit of x and y.
  virtual std::string vertical_unit() const;
  // Returns the scanners of the rows read so far, and maybe of others.
  virtual std::vector<ScannerPose> scanners() const { return {}; }
  // Returns positions that mean a ray without return: 0 0 0, and the scanner's own if the file has it.
  virtual std::vector<Eigen::Vector3d> no_return_places() const { return {Eigen::Vector3d::Zero()}; }
  // Whether the file states 0 0 0 as the place of its scanner. Programs that know no place write it.
  virtual bool has_scanner_at_zero() const { return false; }
  // Whether the classes 7 and 18 are noise. In other formats than LAS, they are labels of any meaning.
  virtual bool has_noise_classes() const { return false; }
  virtual std::vector<ReaderNote> notes() const { return {}; }
  virtual RowFindings findings() const { return {}; }
  // Returns where the file says that its scanner stood, and how it was turned. Some programs leave points in
  // the scanner's own axes, and this pose moves them to their place.
  virtual std::optional<Pose> viewpoint() const { return std::nullopt; }
};

struct ReadOptions {
  std::string columns;  // text files: column names, space separated; empty: from the header line
  // The bytes that a reader may hold of a file whose points cannot be read one by one: LAZ.
  std::uint64_t memory = std::uint64_t{64} << 20;
  Trust trust = Trust::kNeither;
};

// Fills a batch with rows of `stride` bytes, at most `max_rows`, for a reader that has them one by one.
// `put(to)` puts the next row there, and returns false at the end. Returns whether there is a row.
template <class Put>
bool fill_batch(RowBatch& batch, std::size_t max_rows, std::size_t stride, const Put& put) {
  assert(max_rows > 0);
  const std::size_t rows = std::min(max_rows, std::max<std::size_t>(1, kBatchBytes / stride));
  batch.bytes.resize(rows * stride);
  for (batch.count = 0; batch.count < rows; ++batch.count) {
    if (!put(batch.bytes.data() + batch.count * stride)) break;
  }
  batch.bytes.resize(batch.count * stride);
  return batch.count > 0;
}

// The data by which a format is recognised. The name of the file says nothing.
struct FileStart {
  std::string_view first_bytes;
  std::uint64_t size = 0;  // of the whole file

  bool is_whole() const { return first_bytes.size() == size; }
};

// Writing rows to a file: the counterpart of ScanReader.

// A file of rows that is being written.
class RowsWriter {
 public:
  virtual ~RowsWriter() = default;
  // Takes whole rows, one after the other. Throws `Error`.
  virtual void put_rows(std::span<const std::byte> rows) = 0;
  // Ends the file; called once, after all rows. Throws `Error`.
  virtual void finish() {}
};

}  // namespace lacuna::io
