// SPDX-License-Identifier: Apache-2.0
#include "io/results/gis_marks.hpp"

#include "io/results/coverage_tif.hpp"
#include "io/results/loops_gis.hpp"
#include "io/results/voids_gis.hpp"

namespace lacuna::io {
namespace {

using namespace std::string_view_literals;

bool has(std::string_view pages, std::string_view layer, std::string_view description) {
  return pages.find(layer) != pages.npos && pages.find(description) != pages.npos;
}

constexpr std::string_view kSqlite = "SQLite format 3\0"sv;

}  // namespace

FileMark geopackage_mark() {
  return {kSqlite, [](std::string_view pages) { return has(pages, kGisLayer, kGisDescription); }};
}

FileMark voids_gpkg_mark() {
  return {kSqlite, [](std::string_view pages) { return has(pages, kVoidsLayer, kVoidsDescription); }};
}

FileMark coverage_mark() {
  return {"II", [](std::string_view pages) { return pages.find(kCoverageSoftware) != pages.npos; }};
}

}  // namespace lacuna::io
