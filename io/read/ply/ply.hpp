// SPDX-License-Identifier: Apache-2.0
// PLY files as elements: what the header says of them, and their rows behind it, read in either encoding and
// written in one.
// https://paulbourke.net/dataformats/ply/
#pragma once

#include "io/read/files/input_file.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lacuna::io {

enum class PlyFormat : std::uint8_t { kAscii, kLittleEndian, kBigEndian };
const char* ply_name(PlyFormat format);  // "ascii", "binary_little_endian", "binary_big_endian"

struct PlyProperty {
  std::string name;
  Scalar type = Scalar::kFloat32;    // of the value, or of the values of a list
  std::optional<Scalar> count_type;  // of the number before the values of a list; empty for a scalar
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool has_lists() const;
  RowLayout layout() const;  // of its scalars
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  LocalOffset offset;      // of the coordinates, as a comment states it
  std::uint64_t byes = 0;  // lines "bye", which are no keyword
};

// Reads up to and with "end_header" and its line end. All lines of the file end with a carriage return alone
// if the first one does (Rhinoceros). Names of position and normal may be capitals: X is x. Lines "bye",
// which Stanford's archive has in some headers, are counted. "Created by ..." is a
// comment (Blender 2.4). Names are unique among the elements and within each element. The counts are as
// declared: nothing may be allocated by them. Throws `Error` with the line.
PlyHeader read_ply_header(InputFile& in);

// Returns the header as text, "\n" at line ends, with one comment, and a second one for the offset.
std::string print_ply_header(const PlyHeader& header, std::string_view comment);

// The data behind the header of a PLY file, in either encoding.

// Whether the file can hold the rows that the header declares; throws `Error` if not. Afterwards their number
// is safe to count to.
void require_size(const InputFile& in, const PlyHeader& header);

// Whether values have the other byte order than this machine's.
bool is_swapped(PlyFormat format);

// Reads `count` rows of an element: their scalars packed in `rows` as in PlyElement::layout, lists passed
// over. Memory does not grow with the rows or the lists (ASCII: a line is at most as long as InputFile's
// buffer). Throws `Error` where the file ends or does not hold what the header says.
void read_rows(InputFile& in, PlyFormat format, const PlyElement& element, std::uint64_t count,
               std::byte* rows);

// Passes over all rows of one element.
void skip_rows(InputFile& in, PlyFormat format, const PlyElement& element);

using ListVisitor = std::function<void(std::span<const std::int64_t> values)>;

// Hands on the values of one list of each row. `list` is an index into the element's properties; the list
// holds integers. Memory grows with the longest list.
void visit_ascii_lists(InputFile& in, const PlyElement& element, std::size_t list, const ListVisitor& visit);
void visit_binary_lists(InputFile& in, const PlyElement& element, bool swapped, std::size_t list,
                        const ListVisitor& visit);

// Binary little endian PLY, as a stream of values.

class PlyWriter final : public RowsWriter {
 public:
  // Writes the header. The counts of the elements are final. Coordinates are relative to the offset, if there
  // is one. `list_bytes` counts all lists and the numbers before them, which are put like other values.
  PlyWriter(OutputFile& out, std::vector<PlyElement> elements, const LocalOffset& offset = {},
            std::uint64_t list_bytes = 0);

  // Values must follow in the order and with the types of the header.
  template <class T>
  void put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    put_bytes(std::as_bytes(std::span(&value, 1)));
  }
  // Puts a position of the scan, each coordinate as kFloat32 or kFloat64.
  void put_position(Scalar type, const Eigen::Vector3d& position);
  // Puts some values, with the `Scalar` type of the header.
  void put_as(Scalar type, double value);
  void put_bytes(std::span<const std::byte> bytes);
  void put_rows(std::span<const std::byte> rows) override { put_bytes(rows); }

  // Asserts that every value that the header declares was put.
  void finish() override;

 private:
  OutputFile& out_;
  LocalOffset offset_;
  std::uint64_t missing_bytes_ = 0;
};

}  // namespace lacuna::io
