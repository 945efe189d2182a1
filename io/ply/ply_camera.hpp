// SPDX-License-Identifier: Apache-2.0
// The camera of a PLY file: where its scanner stood. VCGlib (MeshLab) writes it before the vertices, PCL
// after them.
#pragma once

#include "io/ply/ply_header.hpp"

#include <filesystem>
#include <optional>

#include <Eigen/Core>

namespace lacuna::io {

// The properties view_px, view_py and view_pz of element `camera`, in the coordinates of the scan. None where
// the element does not have them and exactly one row. None at 0 0 0, too, which programs write where they
// know no viewpoint. `header`: that of the file, after require_size(). Cost: rows before the camera are
// passed over. These are bytes in binary files without lists, and lines or words in all others. Throws
// `Error` where the file ends before, or a number is not finite.
std::optional<Eigen::Vector3d> read_ply_camera(const std::filesystem::path& file, const PlyHeader& header);

}  // namespace lacuna::io
