// SPDX-License-Identifier: Apache-2.0
#include "tests/support/skip.hpp"

#include <cstdlib>

#define CATCH_CONFIG_EXTERNAL_INTERFACES
#include <catch2/catch.hpp>

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

std::optional<std::filesystem::path> shared_folder() {
  namespace fs = std::filesystem;
  const char* named = std::getenv("LACUNA_SHARED");
  const fs::path folder = named ? fs::path(named) : fs::path(LACUNA_SOURCE_DIR).parent_path() / "shared";
  if (fs::is_directory(folder)) return folder;
  skip(folder.string() + " is not there");
  return std::nullopt;
}

bool all_were_skipped() {
  return finished > 0 && skipped == finished;
}

}  // namespace lacuna::test
