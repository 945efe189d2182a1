// SPDX-License-Identifier: Apache-2.0
#include "tools/console/terminal.hpp"

#include "engine/run/disk_space.hpp"
#include "tools/console/measures_text.hpp"

#include <catch2/catch.hpp>

namespace lacuna::tools {
namespace {

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

}  // namespace
}  // namespace lacuna::tools
