// SPDX-License-Identifier: Apache-2.0
// Exit codes: 0, all passed; 1, something failed; 77, all were skipped.
#include "tests/support/skip.hpp"

#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#include <tbb/global_control.h>

int main(int argc, char** argv) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 64);  // more than cores
  if (Catch::Session().run(argc, argv) != 0) return 1;
  return lacuna::test::all_were_skipped() ? lacuna::test::kSkippedExitCode : 0;
}
