// SPDX-License-Identifier: Apache-2.0
#include "engine/config/config.hpp"

#include "engine/config/config_file.hpp"
#include "tests/support/test.hpp"

namespace lacuna {
namespace {

TEST_CASE("the engine's config reads back as itself, and knows no parameter of files") {
  Config config;
  config.neighbourhood.k = 20;
  config.results = {.points = true, .sample_points = 7};
  const ScratchFolder scratch;
  Config again;
  read_config(scratch.write("c.toml", print_config(config)), again);
  CHECK(print_config(again) == print_config(config));
  CHECK(again.results.points);

  REQUIRE_THROWS_WITH(
      read_config(scratch.write("c.toml", "[output]\nreport = true\n"), again),
      Contains(":2: unknown key \"report\" in [output]; allowed there: points, sample_points"));
  REQUIRE_THROWS_WITH(read_config(scratch.write("c.toml", "[input]\ncrs = \"\"\n"), again),
                      Contains(":1: unknown section \"input\""));
}

TEST_CASE("each constant of the tangential method is for the config file alone") {
  Config config;
  for (const Parameter& parameter : parameters(config))
    CHECK(parameter.is_constant == (parameter.section == "tangential"));
  CHECK_THAT(print_config(config),
             Contains("[tangential]\n# Constants of the method, not for ordinary use."));
}

}  // namespace
}  // namespace lacuna
