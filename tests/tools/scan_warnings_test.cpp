#include "tools/scan_warnings.hpp"

#include "tests/io/io_support.hpp"

#include <catch2/catch.hpp>

namespace lacuna::test {
namespace {

using Catch::Matchers::Contains;

std::string las(const std::string& crs) {
  std::string file(227 + 54, '\0');
  const auto put = [&](std::size_t at, auto value) { std::memcpy(&file[at], &value, sizeof value); };
  std::memcpy(file.data(), "LASF", 4);
  put(24, std::uint16_t{0x0201});
  put(94, std::uint16_t{227});
  put(96, static_cast<std::uint32_t>(file.size() + crs.size()));
  put(100, std::uint32_t{1});
  put(105, std::uint16_t{20});
  for (const std::size_t axis : {0, 1, 2}) put(131 + 8 * axis, 1.0);
  std::memcpy(&file[229], "LASF_Projection", 15);
  put(227 + 18, std::uint16_t{2112});
  put(227 + 20, static_cast<std::uint16_t>(crs.size()));
  return file + crs;
}

}  // namespace

TEST_CASE("a file with another coordinate reference system than the first is a warning that names both") {
  const ScratchFolder folder;
  const auto a = folder.write("a.las", las("PROJCS[\"UTM 32N\",X]")),
             b = folder.write("b.las", las("EPSG:4258")), none = folder.write("c.xyz", "1 2 3\n");
  const FileScan scan({a, b, none}, {});
  const std::vector<std::string> warnings = input_warnings(scan);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("b.las: its coordinate reference system is not that of the first file: "
                                   "EPSG:4258, not UTM 32N"));
  CHECK(scan.common_crs().empty());
  CHECK(FileScan({b}, {}).common_crs() == "EPSG:4258");
  CHECK(FileScan({{b, parse_pose("1 2 3 0 0 0 1")}}, {}).common_crs().empty());  // not in these coordinates
}

}  // namespace lacuna::test
