// SPDX-License-Identifier: Apache-2.0
#include "io/results/gis_marks.hpp"

#include "io/results/coverage_tif.hpp"
#include "io/results/loops_gis.hpp"

namespace lacuna::io {
namespace {

using namespace std::string_view_literals;

bool has_layer(std::string_view pages) {
  return pages.find(kGisLayer) != pages.npos && pages.find(kGisDescription) != pages.npos;
}

}  // namespace

FileMark geopackage_mark() {
  return {"SQLite format 3\0"sv, has_layer};
}

FileMark coverage_mark() {
  return {"II", [](std::string_view pages) { return pages.find(kCoverageSoftware) != pages.npos; }};
}

}  // namespace lacuna::io
