#include "tools/scan_warnings.hpp"

#include "tests/io/las/las_file.hpp"
#include "tests/support/scratch_folder.hpp"

#include <catch2/catch.hpp>

namespace lacuna::test {
using namespace io;
using namespace tools;

namespace {

using Catch::Matchers::Contains;

std::string las(const std::string& crs) {
  return LasFile{.records = {las_record("LASF_Projection", 2112, crs)}}.bytes();
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
