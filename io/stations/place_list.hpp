// SPDX-License-Identifier: Apache-2.0
// Places for a scanner, as the user lists them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

struct ListedPosition {
  std::string name;  // empty without a name
  Eigen::Vector3d position{0, 0, 0};
};

// Reads a place from each line, in the order of the file: x y z, or a name without blanks and x y z. The
// rules of lines are in io/stations/list_lines.hpp. Throws `Error`, also if there is no place.
std::vector<ListedPosition> read_places(const std::filesystem::path& list);

}  // namespace lacuna::io
