// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/number.hpp"
#include "io/write/loops/loop_measures.hpp"
#include "io/write/results/results.hpp"

#include <cmath>
#include <string>

namespace lacuna::io {
namespace {

std::string head_of(std::size_t id, const ExplainedLoop& loop) {
  const std::string name = std::string(name_of(loop.kind)) + "_" + std::to_string(id);
  std::string text = "\n";
  if (!loop.cause.name().empty()) text.append("# cause ").append(loop.cause.name()).append("\n");
  for (const LoopMeasure& measure : kLoopMeasures) {
    if (!std::isfinite(measure.of(loop))) continue;
    text += "# " + std::string(measure.name) + " ";
    append_plain(text, measure.of(loop));
    text += "\n";
  }
  return text + "o " + name + "\n";
}

}  // namespace

void write_loops_obj(const ExplainedDetection& detection, OutputFile& out) {
  out.write("# lacuna detect, loops\n");
  std::uint64_t next = 1;  // vertices count from 1, over all objects
  for (std::size_t id = 0; id < detection.loops.size(); ++id) {
    const ExplainedLoop loop = detection.loop(id);
    out.write(head_of(id, loop));
    std::string line;
    detection.for_each_loop_point(id, [&](const LoopPoint& point) {
      line = "v";
      for (const double component : point.position()) append_plain(line += " ", component);
      out.write(line += "\n");
    });
    const std::uint64_t first = next;
    next += loop.points;
    for (std::uint64_t a = first; a < next; ++a) {
      const std::uint64_t b = a + 1 < next ? a + 1 : first;
      out.write("l " + std::to_string(a) + " " + std::to_string(b) + "\n");
    }
  }
}

}  // namespace lacuna::io
