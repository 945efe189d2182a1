#include "tools/terminal.hpp"

#include "tools/parameter_options.hpp"
#include "tools/summary.hpp"

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

using Words = std::vector<std::string>;

TEST_CASE("the progress bar shows phase, share, rate and time left") {
  CHECK(progress_bar("evaluate", 500'000, 1'000'000, 2.0, 72) ==
        "evaluate   [===========           ]  50 %  0.25 M points/s  2.00 s left");
  CHECK(progress_bar("evaluate", 5, 0, 2.0, 80) == "evaluate    0.00 M points/s");
}

TEST_CASE("the progress bar is shorter than the terminal is wide, whatever it shows") {
  for (std::size_t width = 0; width < 200; ++width) {
    for (const std::uint64_t done : {0ull, 1ull, 999ull, 1000ull, 5000ull, ~0ull}) {
      for (const std::uint64_t total : {0ull, 1000ull, ~0ull}) {
        for (const double seconds : {0.0, 1e-9, 100.0, 1e12}) {
          const std::size_t length =
              progress_bar("a phase with a long name", done, total, seconds, width).size();
          REQUIRE(length <= (width > 0 ? width - 1 : 0));
        }
      }
    }
  }
}

TEST_CASE("durations read as a person would say them") {
  CHECK(print_duration(0.004) == "0.00 s");
  CHECK(print_duration(9.994) == "9.99 s");
  CHECK(print_duration(12.34) == "12.3 s");
  CHECK(print_duration(59.96) == "1:00 min");
  CHECK(print_duration(187) == "3:07 min");
  CHECK(print_duration(3723) == "1:02:03 h");
}

TEST_CASE("counts have separators and sizes have units") {
  CHECK(print_count(0) == "0");
  CHECK(print_count(999) == "999");
  CHECK(print_count(1'234'567) == "1,234,567");
  CHECK(print_size(1023) == "1023 bytes");
  CHECK(print_size(1536) == "1.5 KiB");
  CHECK(print_size(512ull << 20) == "512 MiB");
}

TEST_CASE("column names may follow one by one, or as one word") {
  CHECK(join_columns({"detect", "a.txt", "--columns", "x", "y", "z", "--out", "d"}) ==
        Words{"detect", "a.txt", "--columns=x y z", "--out", "d"});
  CHECK(join_columns({"--columns", "x y z", "a.txt"}) == Words{"--columns=x y z", "a.txt"});
  CHECK(join_columns({"--columns", "x", "y", "z", "--", "a.txt"}) == Words{"--columns=x y z", "--", "a.txt"});
  CHECK(join_columns({"--columns"}) == Words{"--columns"});
  CHECK(join_columns({"--", "--columns", "x"}) == Words{"--", "--columns", "x"});
}

}  // namespace
}  // namespace lacuna
