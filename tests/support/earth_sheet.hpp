// SPDX-License-Identifier: Apache-2.0
// A sheet with holes at coordinates as of UTM, with all digits of a double.
#pragma once

#include "tests/io/io_support.hpp"
#include "tests/support/run_program.hpp"

#include <sstream>
#include <string>

#include <catch2/catch.hpp>

namespace lacuna::test {

// Writes it as text to "earth.txt". Returns that name.
inline std::string write_earth_sheet(const ScratchFolder& scratch, const std::string& points = "12000") {
  const std::string surface = (scratch / "surface.ply").string();
  REQUIRE(test::run_bench({"synth", "surface", surface, "--points", points, "--holes", "4", "--hole-radius",
                           "3", "6", "--order", "random"})
              .exit_code == 0);
  std::ostringstream text;
  text.precision(17);
  text << "x y z\n";
  for (const auto& row : read_table(surface).rows)
    text << row[0] + 500'000.1 << ' ' << row[1] + 5'400'000.1 << ' ' << row[2] << '\n';
  return scratch.write("earth.txt", text.str());
}

}  // namespace lacuna::test
