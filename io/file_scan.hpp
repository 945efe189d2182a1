// Several scan files as one registered scan: the engine's view of the input.
#pragma once

#include "engine/model/points.hpp"
#include "io/file_state.hpp"
#include "io/pose.hpp"
#include "io/row_filter.hpp"
#include "io/scan_reader.hpp"

#include <concepts>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lacuna::io {

struct ScanInput {
  template <std::convertible_to<std::filesystem::path> Name>
  ScanInput(Name&& name, std::optional<Pose> pose = {})
      : file(std::forward<Name>(name)), pose(std::move(pose)) {}

  std::filesystem::path file;
  std::optional<Pose> pose;  // of its coordinates in the registered scan
};

// Ids count the rows over the files, in order. A batch lies within one file. Where any file has normals, the
// points of one that has none get NaN. Points that the filters of the config leave out have NaN for a
// position. A file that changes after the first opening is an `Error` when it is opened again.
class FileScan : public PointSource {
 public:
  // Opens every file once, so that a missing or broken one, or one that lacks what a filter needs, is an
  // `Error` before any work is done.
  FileScan(std::vector<ScanInput> inputs, InputConfig config);

  void rewind() override;
  bool next(PointBatch& batch) override;
  std::optional<std::uint64_t> expected_points() const override;
  bool has_normals() const override;   // any file has nx ny nz
  bool reads_slowly() const override;  // any file does

  const std::vector<std::filesystem::path>& files() const { return files_; }
  const std::vector<std::optional<Pose>>& poses() const { return poses_; }  // one per file
  const std::vector<RowLayout>& layouts() const { return layouts_; }        // one per file
  // Rows that each file's header declares; text files declare none.
  const std::vector<std::optional<std::uint64_t>>& expected_rows() const { return expected_rows_; }
  // Of each file, as ScanReader::format says.
  const std::vector<std::string>& formats() const { return formats_; }
  // Of each file; empty where it names none, or has a pose.
  const std::vector<std::string>& crs() const { return crs_; }
  // The one that all files share; empty: they differ, or name none.
  std::string common_crs() const;
  // Of lengths: the one that all files share; empty: they differ, or name none.
  std::string length_unit() const;
  // Of a file: as its header declares, else as many as the last pass has read of it.
  std::uint64_t rows(std::size_t file) const { return expected_rows_[file].value_or(rows_read_[file]); }
  // From its first row on, moved by its pose, without filters.
  std::unique_ptr<ScanReader> open(std::size_t file) const;
  // Of the points read since the last rewind.
  const FilteredOut& filtered_out() const { return filtered_out_; }
  // Throws `Error` if a file is no longer what it was when it was opened first: what was read last from it
  // may not fit what was read before.
  void check_unchanged() const;
  bool single_precision() const;  // x, y and z are 32-bit floats in every file

 private:
  void refuse_too_far(const PointBatch& batch) const;

  std::vector<std::filesystem::path> files_;
  std::vector<std::optional<Pose>> poses_;  // one per file
  InputConfig config_;
  std::vector<FileState> states_;
  std::vector<RowLayout> layouts_;
  std::vector<std::string> crs_, units_, formats_;
  bool has_normals_ = false, reads_slowly_ = false;
  std::vector<std::optional<std::uint64_t>> expected_rows_;
  std::optional<std::uint64_t> expected_points_;
  std::vector<std::uint64_t> rows_read_;  // of each file, in this pass
  // where reading stands
  std::size_t file_ = 0;
  std::uint64_t next_id_ = 0;
  std::unique_ptr<ScanReader> reader_;
  std::optional<RowFilter> filter_;
  RowBatch rows_;
  FilteredOut filtered_out_;
};

}  // namespace lacuna::io
