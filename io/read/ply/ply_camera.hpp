// SPDX-License-Identifier: Apache-2.0
// The camera of a PLY file: the place of its scanner. VCGlib (MeshLab) writes it before the vertices, PCL
// after them.
#pragma once

#include "io/read/ply/ply_header.hpp"

#include <filesystem>
#include <optional>

#include <Eigen/Core>

namespace lacuna::io {

// Returns the properties view_px, view_py and view_pz of element `camera`, in the coordinates of the file.
// Returns nothing unless the element has these properties and exactly one row. `header` is the file's header,
// after require_size(). Cost: the function passes over rows before the camera. They are bytes in binary files
// without lists, and lines or words in all others. Throws `Error` if the file ends before the camera, or a
// number is not finite.
std::optional<Eigen::Vector3d> read_ply_camera(const std::filesystem::path& file, const PlyHeader& header);

}  // namespace lacuna::io
