// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/number.hpp"
#include "io/write/loops/loop_measures.hpp"
#include "io/write/results/results.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

namespace lacuna::io {
namespace {

// Writes an empty field if the value is not finite.
void append(std::string& line, double value) {
  line += ',';
  if (std::isfinite(value)) append_shortest(line, value);
}

std::string table_header(bool has_lids) {
  std::string names = "id,kind";
  for (const LoopMeasure& measure : kLoopMeasures) names.append(",").append(measure.name);
  if (has_lids) names += ",lid_area";
  return names + ",x,y,z,nx,ny,nz,cause,hidden_by_x,hidden_by_y,hidden_by_z\n";
}

// Holes before outer curves, each the largest first.
std::vector<std::size_t> by_size(const std::vector<LoopMeasures>& loops) {
  std::vector<std::size_t> order(loops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rank = [&](std::size_t id) {
    const double area = std::isfinite(loops[id].area) ? loops[id].area : std::numeric_limits<double>::max();
    return std::tuple(loops[id].kind, -area, id);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  return order;
}

}  // namespace

void write_table(const ExplainedDetection& detection, const std::vector<LidMeasures>& lids, OutputFile& out) {
  constexpr int kDigits = 7, kDigitsOfCount = 16;
  const int decimals = place_decimals(detection.summary.median_distance);
  const auto place = [decimals](double value) { return reread(value, std::chars_format::fixed, decimals); };
  out.write(table_header(!lids.empty()));
  for (const std::size_t id : by_size(detection.loops)) {
    const ExplainedLoop loop = detection.loop(id);
    std::string line = std::to_string(id) + "," + name_of(loop.kind);
    for (const LoopMeasure& measure : kLoopMeasures) {
      const int digits = measure.is_count ? kDigitsOfCount : kDigits;
      append(line, reread(measure.of(loop), std::chars_format::general, digits));
    }
    if (!lids.empty()) append(line, reread(lids[id].area, std::chars_format::general, kDigits));
    for (const double coordinate : loop.centroid) append(line, place(coordinate));
    for (const double component : loop.normal)
      append(line, reread(component, std::chars_format::general, kDigits));
    line.append(",").append(loop.cause.name());
    for (const double coordinate : loop.cause.hidden_by) append(line, place(coordinate));
    out.write(line + "\n");
  }
}

}  // namespace lacuna::io
