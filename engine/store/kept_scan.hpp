// SPDX-License-Identifier: Apache-2.0
// A scan that is decoded once: its points are in a temporary file for all later passes.
#pragma once

#include "engine/model/points.hpp"
#include "engine/store/store_file.hpp"

#include <cstdint>
#include <filesystem>

namespace lacuna {

// For sources that are slower to read than a file of plain numbers. The first pass reads the source and
// writes 24 bytes a point, 48 with normals. Later passes read these bytes, and never the source. Points have
// the ids of the source, which must count from 0 without gaps.
class KeptScan final : public PointSource {
 public:
  // `scan` must outlive this object. `file`: a temporary file.
  KeptScan(PointSource& scan, const std::filesystem::path& file);

  void rewind() override;
  bool next(PointBatch& batch) override;
  std::optional<std::uint64_t> expected_points() const override { return scan_.expected_points(); }
  bool has_normals() const override { return scan_.has_normals(); }
  std::vector<std::uint64_t> pass_counts() const override { return scan_.pass_counts(); }
  void refuse_empty() const override { scan_.refuse_empty(); }

 private:
  bool next_of_source(PointBatch& batch);
  bool next_kept(PointBatch& batch);

  PointSource& scan_;
  StoreFile positions_, normals_;
  std::uint64_t next_ = 0;  // point
  std::uint64_t points_ = 0;
  bool is_kept_ = false;  // all of them
};

}  // namespace lacuna
