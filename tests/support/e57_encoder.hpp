// SPDX-License-Identifier: Apache-2.0
// Writes E57 files for tests of the reader: a mirror of ASTM E2807-11, simple, and without code of the
// reader.
#pragma once

#include "tests/support/test.hpp"

namespace lacuna::test {

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
