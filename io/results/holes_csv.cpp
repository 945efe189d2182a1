// SPDX-License-Identifier: Apache-2.0
#include "io/files/number.hpp"
#include "io/loops/loop_measures.hpp"
#include "io/results/results.hpp"

#include <cmath>
#include <string>

namespace lacuna::io {
namespace {

// Writes an empty field if the value is not finite.
void append(std::string& line, double value, bool is_count = false) {
  line += ',';
  if (!std::isfinite(value)) return;
  if (is_count) {
    line += std::to_string(static_cast<std::uint64_t>(value));
  } else {
    append_shortest(line, value);
  }
}

std::string table_header() {
  std::string names = "id,kind";
  for (const LoopMeasure& measure : kLoopMeasures) names.append(",").append(measure.name);
  return names + ",x,y,z,nx,ny,nz,cause,hidden_by_x,hidden_by_y,hidden_by_z\n";
}

}  // namespace

void write_table(const ExplainedDetection& detection, OutputFile& out) {
  out.write(table_header());
  for (std::size_t id = 0; id < detection.loops.size(); ++id) {
    const ExplainedLoop loop = detection.loop(id);
    std::string line = std::to_string(id) + "," + name_of(loop.kind);
    for (const LoopMeasure& measure : kLoopMeasures) append(line, measure.of(loop), measure.is_count);
    for (const Eigen::Vector3d& vector : {loop.centroid, loop.normal}) {
      for (const double component : vector) append(line, component);
    }
    line.append(",").append(loop.cause.name());
    for (const double component : loop.cause.hidden_by) append(line, component);
    out.write(line + "\n");
  }
}

}  // namespace lacuna::io
