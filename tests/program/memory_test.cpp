// Memory is bounded by the setting, as the operating system measures it. Slow.
#include "engine/config.hpp"
#include "tests/support/run_program.hpp"

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

void check_memory(const std::string& points, const std::string& limit) {
  const test::ScratchFolder scratch;
  const std::string scan = (scratch / "surface.ply").string();
  REQUIRE(test::run_program({"synth", "surface", scan, "--points", points, "--holes", "100"}).exit_code == 0);
  const test::ProgramResult limited = test::run_program(
      {"detect", scan, "--out", (scratch / "limited").string(), "--quiet", "--memory-limit", limit});
  INFO(limited.err);
  REQUIRE(limited.exit_code == 0);
  WARN(points << " points in " << limit << ": peak " << limited.peak_memory / (1 << 20) << " MiB");
  CHECK(limited.peak_memory < parse_bytes(limit));
  REQUIRE(test::run_program({"detect", scan, "--out", (scratch / "free").string(), "--quiet"}).exit_code ==
          0);
  for (const char* file : {"boundary.ply", "loops.ply"}) {
    const bool same = test::read_file(scratch / "limited" / file) == test::read_file(scratch / "free" / file);
    INFO(file);
    CHECK(same);
  }
}

TEST_CASE("sixteen million points stay within 512 MiB, with the same results as without a limit", "[.slow]") {
  check_memory("16000000", "512MiB");
}

TEST_CASE("four million points stay within 256 MiB, with the same results as without a limit", "[.slow]") {
  check_memory("4000000", "256MiB");
}

}  // namespace
}  // namespace lacuna
