// Writes a line per finished test case, "pass NAME" or "fail NAME", to the file named by LACUNA_TEST_REPORT:
// what tools/check.sh counts. A crash leaves a test begun but not finished.
#include <cstdlib>
#include <fstream>

#define CATCH_CONFIG_EXTERNAL_INTERFACES
#include <catch2/catch.hpp>

namespace {

class TestReport final : public Catch::TestEventListenerBase {
 public:
  using TestEventListenerBase::TestEventListenerBase;

  void testCaseStarting(const Catch::TestCaseInfo& test) override { write("begin " + test.name); }
  void testCaseEnded(const Catch::TestCaseStats& stats) override {
    write((stats.totals.testCases.failed > 0 ? "fail " : "pass ") + stats.testInfo.name);
  }

 private:
  static void write(const std::string& line) {
    if (const char* file = std::getenv("LACUNA_TEST_REPORT"))
      std::ofstream(file, std::ios::app) << line << '\n';
  }
};

CATCH_REGISTER_LISTENER(TestReport)

}  // namespace
