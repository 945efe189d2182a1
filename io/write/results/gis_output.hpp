// SPDX-License-Identifier: Apache-2.0
// A file that GDAL makes.
#pragma once

#include <filesystem>
#include <string>

namespace lacuna::io {

struct GisOutput {
  std::string crs;              // as CommonSystem::crs
  std::filesystem::path name;   // what errors call it
  std::filesystem::path place;  // where it is made
};

}  // namespace lacuna::io
