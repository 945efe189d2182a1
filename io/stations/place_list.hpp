// SPDX-License-Identifier: Apache-2.0
// Places at which a scanner may stand, as the user lists them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

struct NamedPlace {
  std::string name;  // empty: none
  Eigen::Vector3d place{0, 0, 0};
};

// Reads a place from each line, in the order of the file: x y z, or a name without blanks and x y z. Lines
// are those of io/stations/list_lines.hpp. Throws `Error`, where there is no place, too.
std::vector<NamedPlace> read_places(const std::filesystem::path& list);

}  // namespace lacuna::io
