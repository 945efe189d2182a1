// SPDX-License-Identifier: Apache-2.0
#include "io/results/gis_marks.hpp"

#include "io/loops/loop_measures.hpp"
#include "io/results/coverage_tif.hpp"
#include "io/results/loops_gis.hpp"

namespace lacuna::io {
namespace {

using namespace std::string_view_literals;

bool has_layer(std::string_view pages) {
  return pages.find(kGisLayer) != pages.npos && pages.find(kGisDescription) != pages.npos;
}

// dBASE III: a head of 32 bytes, then 32 for each field, which begin with its name, padded with zeros to 11.
bool has_fields(std::string_view head) {
  constexpr std::size_t kBytes = 32, kNameBytes = 11;
  std::size_t at = kBytes;
  const auto is_next = [&](std::string_view name) {
    std::string padded(name);
    padded.resize(kNameBytes, '\0');
    const bool is_it = head.size() > at && head.substr(at, kNameBytes) == padded;
    at += kBytes;
    return is_it;
  };
  if (!is_next("id") || !is_next("kind") || !is_next("cause") || !is_next("unit")) return false;
  for (const LoopMeasure& measure : kLoopMeasures) {
    if (!is_next(measure.short_name)) return false;
  }
  return head.size() > at && head[at] == '\r';  // the end of the fields
}

}  // namespace

FileMark geopackage_mark() {
  return {"SQLite format 3\0"sv, has_layer};
}

FileMark shapefile_mark() {
  return {"\3"sv, has_fields, ".dbf"};
}

FileMark coverage_mark() {
  return {"II", [](std::string_view pages) { return pages.find(kCoverageSoftware) != pages.npos; }};
}

}  // namespace lacuna::io
