// SPDX-License-Identifier: Apache-2.0
// Small files of points, drawn as text; and E57 files, which a mirror of ASTM E2807-11 writes, simple and
// without code of the reader.
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

// A field of the points: its element in the prototype, and its bytestream.
struct E57Values {
  std::string name;
  std::string attributes;  // of the element
  std::string bytes;
  std::size_t count = 0;
};

E57Values e57_floats(const std::string& name, const std::vector<float>& values);
E57Values e57_doubles(const std::string& name, const std::vector<double>& values);
std::vector<E57Values> e57_position(const std::vector<double>& x, const std::vector<double>& y,
                                    const std::vector<double>& z);
// Packed into as many bits as the limits need.
E57Values e57_integers(const std::string& name, std::int64_t minimum, std::int64_t maximum,
                       const std::vector<std::int64_t>& values);
// `values` before scale and offset.
E57Values e57_scaled(const std::string& name, std::int64_t minimum, std::int64_t maximum, double scale,
                     double offset, const std::vector<std::int64_t>& values);

struct E57TestScan {
  std::vector<E57Values> fields;
  std::string pose;         // XML next to the points
  std::size_t packets = 1;  // the bytes of each field are divided unevenly between them
  std::string codecs;       // XML within the points
};

// The XML of a pose.
std::string e57_pose(const std::vector<double>& quaternion, const std::vector<double>& translation);

struct E57FileForm {
  std::size_t page_bytes = 1024;
  bool has_other_packets = true;  // one of an index before the data, and an empty one before the last
  std::string root;               // XML next to data3D
};

std::string encode_e57(const std::vector<E57TestScan>& scans, const E57FileForm& form = {});

// Sets the checksums of all whole pages.
void repair_e57_checksums(std::string& file, std::size_t page_bytes = 1024);

}  // namespace lacuna::test
