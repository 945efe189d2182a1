// SPDX-License-Identifier: Apache-2.0
// Binary little endian PLY, as a stream of values.
#pragma once

#include "io/read/files/output_file.hpp"
#include "io/read/ply/ply.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace lacuna::io {

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
