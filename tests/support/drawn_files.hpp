// SPDX-License-Identifier: Apache-2.0
// Small files of points, drawn as text.
#pragma once

#include "tests/support/test.hpp"

namespace lacuna::test {

inline const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
inline const std::string kWideXyz = "property double x\nproperty double y\nproperty double z\n";

// Elements of PLY: where the scanner stood, and polygons.
inline const std::string kCamera =
    "element camera 1\nproperty float view_px\nproperty float view_py\nproperty float view_pz\n";
inline const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";

inline std::string vertices(std::size_t count, const std::string& properties = kXyz) {
  return "element vertex " + std::to_string(count) + "\n" + properties;
}

// The header of a PLY with these elements.
inline std::string ply_header(const std::string& elements, const std::string& format = "ascii") {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

// A PLY of vertices alone, one in each line of `rows`.
inline std::string ascii_ply(const std::string& rows, const std::string& properties = kXyz) {
  const auto count = static_cast<std::size_t>(std::count(rows.begin(), rows.end(), '\n'));
  return ply_header(vertices(count, properties)) + rows;
}

// A PCD of a point in each line of `rows`, with the place of the scanner.
inline std::string ascii_pcd(const std::string& rows, const std::string& viewpoint = "0 0 0") {
  const std::string count = std::to_string(std::count(rows.begin(), rows.end(), '\n'));
  return "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + count +
         "\nHEIGHT 1\nVIEWPOINT " + viewpoint + " 1 0 0 0\nPOINTS " + count + "\nDATA ascii\n" + rows;
}

}  // namespace lacuna::test
