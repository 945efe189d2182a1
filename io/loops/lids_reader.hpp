// SPDX-License-Identifier: Apache-2.0
// Reads lids.obj, from which the other files of lids are made.
#pragma once

#include "io/lids/lid_mesh.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace lacuna::io {

// The comments of lids.obj: three before an object, or one that names a hole, kNoLid and the reason.
inline constexpr std::string_view kLidVertices = "vertices", kLidTriangles = "triangles",
                                  kLidArea = "lid_area";
inline constexpr std::string_view kNoLid = " has no lid: ";

struct LidRecord {
  std::uint64_t loop = 0;  // the id of the hole
  std::uint64_t vertices = 0, triangles = 0;
  double area = 0;
  std::string left_out;  // the reason; empty if it has a lid
};

// The functions that the reader calls, in the order of the file; each may be empty. Triangles count vertices
// from 0, over the file.
struct LidVisits {
  std::function<void(const LidRecord&)> hole = {};
  std::function<void(const LidRecord&, const Eigen::Vector3d&)> vertex = {};
  std::function<void(const LidRecord&, const std::array<std::uint64_t, 3>&)> triangle = {};
};

// Streams a file that write_lids_obj has written. Throws `Error` if a line cannot be read.
void read_lids(const std::filesystem::path& lids_obj, const LidVisits& visits);

}  // namespace lacuna::io
