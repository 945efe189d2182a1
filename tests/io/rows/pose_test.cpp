// SPDX-License-Identifier: Apache-2.0
#include "io/read/rows/pose.hpp"

#include "io/read/scan/scan_pass.hpp"
#include "tests/io/io_support.hpp"

namespace lacuna::test {
namespace {

// A quarter turn around z, then a move.
constexpr const char* kMatrix = "0 -1 0 10\n1 0 0 20\n0 0 1 30\n0 0 0 1\n";

}  // namespace

TEST_CASE("a pose is a matrix, its first three rows, or a translation and a quaternion") {
  const Pose matrix = parse_pose(kMatrix);
  CHECK(matrix * Eigen::Vector3d(1, 2, 3) == Eigen::Vector3d(8, 21, 33));
  CHECK(parse_pose("0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30").matrix() == matrix.matrix());
  const double half = std::sqrt(0.5);
  const Pose turned = parse_pose("10 20 30 0 0 " + std::to_string(half) + " " + std::to_string(half));
  CHECK((turned.matrix() - matrix.matrix()).norm() < 1e-5);
  CHECK(parse_pose("1000 0 0 5 0 1000 0 6 0 0 1000 7") * Eigen::Vector3d(1, 2, 3) ==
        Eigen::Vector3d(1005, 2006, 3007));
}

TEST_CASE("what does not only turn, scale and move is no pose") {
  const std::string odd = "shears, mirrors or flattens";
  check_reasons({{"1 2 3", "a pose of 3 numbers; allowed: 16"},
                 {"1 2 3 0 0 0 2", "the quaternion of a pose has length 2"},
                 {"1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1", "may be transposed"},
                 {"1 0 0 0 0 1 0 0 0 0 -1 0", odd},
                 {"1 0 0 0 0 1 0 0 0 0 0 0", odd},
                 {"0 0 0 0 0 0 0 0 0 0 0 0", odd},
                 {"1 0.1 0 0 0 1 0 0 0 0 1 0", odd},
                 {"1 0 0 0 0 one 0 0 0 0 1 0", "'one' is no number of a pose"},
                 {"1 0 0 nan 0 1 0 0 0 0 1 0", "'nan' is no number of a pose"}},
                [](const std::string& numbers) { return error_of([&] { parse_pose(numbers); }); });
}

TEST_CASE("a file of a pose that holds none is an error that names it") {
  const ScratchFolder folder;
  CHECK(read_pose(folder.write("a.xf", kMatrix)).matrix() == parse_pose(kMatrix).matrix());
  CHECK_THAT(error_of([&] { read_pose(folder.write("b.xf", "1 0 0\n")); }), Contains("b.xf: a pose of 3"));
  CHECK_THAT(error_of([&] { read_pose(folder / "none.xf"); }), Contains("none.xf"));
}

TEST_CASE("a pose moves positions, turns normals without scaling them, and keeps all else") {
  const ScratchFolder folder;
  const auto ply = folder.write(
      "a.ply",
      ascii_ply("200 1 2 3 1 0 0\n",
                "property uchar red\n" + kXyz + "property float nx\nproperty float ny\nproperty float nz\n"));
  const Pose pose = parse_pose("0 -2 0 10  2 0 0 20  0 0 2 30");
  const ScanFiles scan({{ply, pose}, {ply}}, {});
  CHECK(scan.files()[0].layout.find("x")->type == Scalar::kFloat64);
  CHECK(scan.files()[0].layout.find("red")->type == Scalar::kUint8);
  CHECK_FALSE(has_single_precision(scan));
  ScanPass pass(scan);
  PointBatch batch;
  REQUIRE(pass.next(batch));
  CHECK(batch.positions[0] == Eigen::Vector3d(6, 22, 36));
  CHECK((batch.normals[0] - Eigen::Vector3d(0, 1, 0)).norm() < 1e-15);
  REQUIRE(pass.next(batch));
  CHECK(batch.positions[0] == Eigen::Vector3d(1, 2, 3));

  const auto reader = scan.open(0);
  RowBatch rows;
  REQUIRE(reader->next(rows, 10));
  CHECK(rows.bytes[reader->layout().find("red")->offset] == std::byte{200});
}

}  // namespace lacuna::test
