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

inline std::string ply_format(std::endian order) {
  return order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
}

// A PLY of vertices alone, one in each line of `rows`.
inline std::string ascii_ply(const std::string& rows, const std::string& properties = kXyz) {
  const auto count = static_cast<std::size_t>(std::count(rows.begin(), rows.end(), '\n'));
  return ply_header(vertices(count, properties)) + rows;
}

// The header of a PCD, whose `fields` are its four lines of them.
inline std::string pcd_header(const std::string& fields, std::size_t points, const std::string& data,
                              const std::string& viewpoint = "0 0 0") {
  const std::string count = std::to_string(points);
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + "WIDTH " + count +
         "\nHEIGHT 1\nVIEWPOINT " + viewpoint + " 1 0 0 0\nPOINTS " + count + "\nDATA " + data + "\n";
}

// A PCD of a point in each line of `rows`, with the place of the scanner.
inline std::string ascii_pcd(const std::string& rows, const std::string& viewpoint = "0 0 0") {
  const auto count = static_cast<std::size_t>(std::count(rows.begin(), rows.end(), '\n'));
  return pcd_header("FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\n", count, "ascii", viewpoint) + rows;
}

}  // namespace lacuna::test
