// SPDX-License-Identifier: Apache-2.0
#include "tools/console/measures_text.hpp"

#include "engine/run/disk_space.hpp"
#include "tests/support/test.hpp"
#include "tools/commands/summary.hpp"
#include "tools/console/terminal.hpp"

namespace lacuna::tools {
namespace {

TEST_CASE("durations read as a person would say them, counts have separators and sizes units") {
  CHECK(print_duration(0.004) == "0.00 s");
  CHECK(print_duration(9.994) == "9.99 s");
  CHECK(print_duration(12.34) == "12.3 s");
  CHECK(print_duration(59.96) == "1:00 min");
  CHECK(print_duration(187) == "3:07 min");
  CHECK(print_duration(3723) == "1:02:03 h");
  CHECK(print_count(0) == "0");
  CHECK(print_count(999) == "999");
  CHECK(print_count(1'234'567) == "1,234,567");
  CHECK(print_size(1023) == "1023 bytes");
  CHECK(print_size(1536) == "1.5 KiB");
  CHECK(print_size(512ull << 20) == "512 MiB");
}

TEST_CASE("lengths and shares have three digits, and the unit where there is one") {
  CHECK(print_length(2.2834, "m") == "2.28 m");
  CHECK(print_length(2.2834, "") == "2.28");
  CHECK(print_length(0, "m") == "0.00 m");
  CHECK(print_length(0.0123456, "") == "0.0123");
  CHECK(print_length(9.996, "") == "10.0");
  CHECK(print_length(99.96, "") == "100");
  CHECK(print_length(999.6, "") == "1,000");
  CHECK(print_length(7033.2, "ft") == "7,033 ft");
  CHECK(print_length(1.5e-7, "") == "1.5e-07");
  CHECK(print_length(2.5e9, "") == "2,500,000,000");
  CHECK(print_area(3.974, "m") == "3.97 m²");
  CHECK(print_share(0.8734) == "87.3 %");
  CHECK(print_share(1) == "100 %");
  CHECK(print_share(0) == "0.00 %");
}

TEST_CASE("places of one scan have as many decimals, by its extent") {
  CHECK(print_place({1.23456, -0.001, 2}, 9.5) == "1.23 0.00 2.00");
  CHECK(print_place({500123.456, 12.3, 2}, 900) == "500123 12 2");
  CHECK(print_place({1, 2, 3}, 0) == "1.00 2.00 3.00");
  CHECK(print_place({0.0512345, 0, 0}, 0.05) == "0.0512 0.0000 0.0000");
}

}  // namespace
}  // namespace lacuna::tools
