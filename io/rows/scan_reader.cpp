// SPDX-License-Identifier: Apache-2.0
#include "io/rows/scan_reader.hpp"

#include "io/crs/crs_text.hpp"
#include "io/crs/length_unit.hpp"

namespace lacuna::io {

bool ScanReader::is_geographic() const {
  return io::is_geographic(crs());
}

std::string ScanReader::vertical_unit() const {
  return io::vertical_unit(crs());
}

std::string ScanReader::length_unit() const {
  return io::length_unit(crs());
}

ReaderNote note_of_faces(std::uint64_t count, const char* thing) {
  return {.count = count,
          .thing = thing,
          .what =
              "; only their vertices are read; CloudCompare or MeshLab sample points on faces, which show "
              "the whole surface"};
}

}  // namespace lacuna::io
