// SPDX-License-Identifier: Apache-2.0
// Writes the golden results anew. See tests/support/golden.hpp.
#include "tests/support/golden.hpp"
#include "tests/support/reference.hpp"

#include <cstdio>
#include <exception>
#include <fstream>

namespace lacuna {
namespace {

GoldenOutcome plain_outcome(const GoldenCase& golden) {
  const reference::Detection plain = reference::detect(golden.cloud.positions, {}, golden.config);
  GoldenOutcome outcome;
  for (const reference::Point& p : plain.points)
    outcome.points.push_back({p.probability, p.coherent, p.boundary});
  for (std::size_t i = 0; i < plain.loops.size(); ++i)
    outcome.loops.push_back({plain.loops[i], plain.confidences[i]});
  return outcome;
}

}  // namespace
}  // namespace lacuna

int main() {
  try {
    std::ofstream file(LACUNA_SOURCE_DIR "/" + lacuna::kGoldenFile);
    file.exceptions(std::ios::failbit | std::ios::badbit);
    file << "# What the plain reference finds in drawn clouds. See tests/support/golden.hpp.\n";
    for (const lacuna::GoldenCase& golden : lacuna::golden_cases())
      file << golden_lines(golden, lacuna::plain_outcome(golden));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_golden: %s\n", error.what());
    return 1;
  }
}
