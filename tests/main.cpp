// SPDX-License-Identifier: Apache-2.0
// Exit codes: 0, all passed; 1, something failed; 77, all were skipped. Catch2 v2 knows only passed and failed
// tests, so a skipped one has an exit code of its own.
#define CATCH_CONFIG_RUNNER
#include "tests/support/test.hpp"

#include <tbb/global_control.h>

namespace lacuna::test {
namespace {

bool skipped_now = false;
int finished = 0, skipped = 0;

class CountSkipped final : public Catch::TestEventListenerBase {
 public:
  using TestEventListenerBase::TestEventListenerBase;

  void testCaseStarting(const Catch::TestCaseInfo&) override { skipped_now = false; }
  void testCaseEnded(const Catch::TestCaseStats&) override {
    ++finished;
    skipped += skipped_now;
  }
};

CATCH_REGISTER_LISTENER(CountSkipped)

}  // namespace

void skip(const std::string& reason) {
  WARN("skipped: " << reason);
  skipped_now = true;
}

std::optional<fs::path> shared_folder() {
  const char* named = std::getenv("LACUNA_SHARED");
  const fs::path folder = named ? fs::path(named) : fs::path(LACUNA_SOURCE_DIR).parent_path() / "shared";
  if (fs::is_directory(folder)) return folder;
  skip(folder.string() + " is not there");
  return std::nullopt;
}

}  // namespace lacuna::test

int main(int argc, char** argv) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 64);  // more than cores
  if (Catch::Session().run(argc, argv) != 0) return 1;
  constexpr int kSkippedExitCode = 77;  // SKIP_RETURN_CODE in tests/CMakeLists.txt
  using namespace lacuna::test;
  return finished > 0 && skipped == finished ? kSkippedExitCode : 0;
}
