#include "io/results/results.hpp"

#include <charconv>
#include <cmath>
#include <initializer_list>
#include <string>

namespace lacuna {
namespace {

// The shortest digits that are this number; empty where it is not finite.
void append(std::string& line, double value) {
  char digits[32];
  line += ',';
  if (std::isfinite(value)) line.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace

void write_table(const Detection& detection, OutputFile& out) {
  out.write(std::string(kTableHeader) + "\n");
  for (std::size_t id = 0; id < detection.loops().size(); ++id) {
    const LoopMeasures& loop = detection.loops()[id];
    std::string line =
        std::to_string(id) + "," + std::string(name_of(loop.kind)) + "," + std::to_string(loop.points);
    for (const double value : {loop.confidence, loop.perimeter, loop.area, loop.diameter, loop.planarity,
                               loop.mean_probability, loop.centroid.x(), loop.centroid.y(), loop.centroid.z(),
                               loop.normal.x(), loop.normal.y(), loop.normal.z()}) {
      append(line, value);
    }
    out.write(line + "\n");
  }
}

}  // namespace lacuna
