// SPDX-License-Identifier: Apache-2.0
#include "engine/store/kept_scan.hpp"

#include "tests/support/memory_scan.hpp"

namespace lacuna {
namespace {

// Counts what is read of it.
class CountedScan final : public PointSource {
 public:
  explicit CountedScan(const Cloud& cloud) : scan_(cloud) {}

  void rewind() override { scan_.rewind(); }
  bool next(PointBatch& batch) override {
    const bool has_more = scan_.next(batch);
    points_read += batch.size();
    return has_more;
  }
  std::optional<std::uint64_t> expected_points() const override { return scan_.expected_points(); }
  bool has_normals() const override { return scan_.has_normals(); }

  std::size_t points_read = 0;

 private:
  MemoryScan scan_;
};

bool is_same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::memcmp(a.data(), b.data(), 3 * sizeof(double)) == 0;  // NaN is NaN
}

void check_kept(const Cloud& cloud) {
  const ScratchFolder folder;
  CountedScan scan(cloud);
  KeptScan kept(scan, folder / "input");
  PointBatch batch;
  kept.next(batch);  // a pass that is given up
  for (int pass = 0; pass < 3; ++pass) {
    scan.points_read = 0;
    kept.rewind();
    const Cloud all = read_points(kept);
    CHECK(scan.points_read == (pass == 0 ? cloud.size() : 0));
    CHECK(std::equal(all.positions.begin(), all.positions.end(), cloud.positions.begin(),
                     cloud.positions.end(), is_same));
    CHECK(std::equal(all.normals.begin(), all.normals.end(), cloud.normals.begin(), cloud.normals.end(),
                     is_same));
  }
}

TEST_CASE("a scan that is kept is read once, and each pass has the same points") {
  check_kept(scattered(200'000, 1));
  check_kept(plane(40).with_unusable(20, 2).with_random_normals(3));
  check_kept({});
}

}  // namespace
}  // namespace lacuna
