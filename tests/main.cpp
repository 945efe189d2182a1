// Exit codes: 0, all passed; 1, something failed; 77, all were skipped.
#include "tests/support/skip.hpp"

#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

int main(int argc, char** argv) {
  if (Catch::Session().run(argc, argv) != 0) return 1;
  return lacuna::test::all_were_skipped() ? lacuna::test::kSkippedExitCode : 0;
}
