// SPDX-License-Identifier: Apache-2.0
#include "io/read/ply/ply_writer.hpp"

#include "io/read/rows/columns.hpp"

#include <array>
#include <bit>
#include <cassert>
#include <utility>

namespace lacuna::io {

static_assert(std::endian::native == std::endian::little, "values are written as they are in memory");

PlyWriter::PlyWriter(OutputFile& out, std::vector<PlyElement> elements, const LocalOffset& offset,
                     std::uint64_t list_bytes)
    : out_(out), offset_(offset), missing_bytes_(list_bytes) {
  const PlyHeader header{
      .format = PlyFormat::kLittleEndian, .elements = std::move(elements), .offset = offset};
  for (const PlyElement& element : header.elements) missing_bytes_ += element.count * element.layout().stride;
  out_.write(print_ply_header(header, "lacuna detect"));
}

void PlyWriter::put_position(Scalar type, const Eigen::Vector3d& position) {
  const Eigen::Vector3d in_file = offset_ ? position - *offset_ : position;
  std::array<std::byte, sizeof(double)> bytes;
  for (const double coordinate : in_file) {
    put_floating(bytes.data(), type, coordinate);
    put_bytes(std::span(bytes).first(size_of(type)));
  }
}

void PlyWriter::put_as(Scalar type, double value) {
  with_type(type, [&](auto target) { put(static_cast<decltype(target)>(value)); });
}

void PlyWriter::put_bytes(std::span<const std::byte> bytes) {
  assert(bytes.size() <= missing_bytes_);
  missing_bytes_ -= bytes.size();
  out_.write(bytes);
}

void PlyWriter::finish() {
  assert(missing_bytes_ == 0);
}

}  // namespace lacuna::io
