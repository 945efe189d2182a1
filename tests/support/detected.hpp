// SPDX-License-Identifier: Apache-2.0
// A cloud in memory as the engine's input, and a finished run of the engine, all of it in memory, to be
// compared.
#pragma once

#include "engine/model/points.hpp"
#include "engine/pipeline.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {

class MemoryScan : public PointSource {
 public:
  explicit MemoryScan(const Cloud& cloud, std::size_t batch = 1000) : cloud_(cloud), batch_(batch) {}

  void rewind() override { rewind_to({0, kParts}, PointId{0}); }
  bool next(PointBatch& batch) override;
  std::optional<std::uint64_t> expected_points() const override { return cloud_.size(); }
  bool has_normals() const override { return !cloud_.normals.empty(); }
  SourceParts parts() const override;
  void rewind_to(const IndexRange& parts, PointId first) override;

 private:
  static constexpr std::size_t kParts = 5;  // of equal sizes
  std::size_t first_of(std::size_t part) const { return cloud_.size() * part / kParts; }

  const Cloud& cloud_;
  std::size_t batch_;
  std::size_t next_ = 0;
  std::size_t first_ = 0, end_ = cloud_.size();
  PointId id_{};
};

// All points that a source has left, whose ids count from 0.
Cloud read_points(PointSource& source);

struct Detected {
  Summary summary;
  std::vector<PointResult> points;  // one per row of the input
  std::vector<BoundaryPoint> boundary;
  std::vector<ReportedLoop> loops;

  std::vector<std::vector<PointId>> loop_ids() const;
  // Every byte of the result that must not depend on the tiling.
  std::string bytes() const;
};

// Runs the engine in a workspace of its own, with results.points.
Detected run_engine(const Cloud& cloud, Config config);
Detected run_engine(PointSource& scan, Config config);
Detected run_engine(PointSource& scan, Config config, Progress& progress);

}  // namespace lacuna
