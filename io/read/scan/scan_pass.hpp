// SPDX-License-Identifier: Apache-2.0
// A pass over the rows of a scan: the engine's view of the input. It filters rows, and counts what it reads.
#pragma once

#include "engine/export.hpp"
#include "engine/model/points.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/read/scan/row_filter.hpp"
#include "io/read/scan/scan_files.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace lacuna::io {

// An observer of all rows of a scan that are read, in order.
class RowObserver {
 public:
  virtual ~RowObserver() = default;
  virtual void begin() {}  // at the first row, or at the first again
  // `read`: where the rows lie; `kept`: likewise, NaN where a filter has left a row out.
  virtual void take(std::size_t file, const ScanReader& reader, const RowBatch& rows,
                    std::span<const Eigen::Vector3d> read, std::span<const Eigen::Vector3d> kept) = 0;
  virtual void end() {}  // every row was there
};

// What a pass counts in a file.
struct FileCounts {
  std::uint64_t rows = 0;
  // Points that are nearer to 0 0 0 than to the file's only scanner, and the others.
  std::uint64_t nearer_to_zero = 0, nearer_to_scanner = 0;
  RowFindings findings;
};

struct ScanCounts {
  std::vector<FileCounts> files;
  FilteredOut filtered_out;
};

// Returns the rows of each file: as its header declares, else as they were counted.
std::vector<std::uint64_t> rows_of(const ScanFiles& scan, const ScanCounts& counts);

// Ids count the rows over the files, in order. A batch lies within one file. If any file has normals, the
// points of a file without normals get NaN. Points that the filters of the config leave out have NaN for a
// position. A file that has changed since its first opening is an `Error`.
class LACUNA_API ScanPass final : public PointSource {
 public:
  // The scan must outlive the pass, and so must the observer, unless it is null.
  explicit ScanPass(const ScanFiles& scan, RowObserver* observer = nullptr);

  void rewind() override { rewind_to({0, scan_.files().size()}, PointId{0}); }
  bool next(PointBatch& batch) override;
  std::optional<std::uint64_t> expected_points() const override { return scan_.expected_points(); }
  bool has_normals() const override { return scan_.has_normals(); }
  bool reads_slowly() const override { return scan_.reads_slowly(); }
  SourceParts parts() const override;  // files
  void rewind_to(const IndexRange& files, PointId first) override;
  std::vector<std::uint64_t> pass_counts() const override;
  void set_pass_counts(std::span<const std::uint64_t> counts) override;
  void refuse_empty() const override;  // arrays without a point are no error

  const ScanCounts& counts() const { return counts_; }  // of the last pass

 private:
  void open_file();
  void take_rows(PointBatch& batch);
  void count_nearer(std::span<const Eigen::Vector3d> positions);
  void refuse_too_far(const PointBatch& batch) const;

  const ScanFiles& scan_;
  RowObserver* observer_;
  ScanCounts counts_;
  IndexRange files_;  // that the pass reads
  // where reading goes on
  std::size_t file_ = 0;
  std::uint64_t next_id_ = 0;
  std::unique_ptr<ScanReader> reader_;
  std::optional<RowFilter> filter_;
  RowBatch rows_;
  bool has_point_ = false;             // a finite one was there in this pass
  std::vector<Eigen::Vector3d> read_;  // positions before the filters, for the observer
};

// Reads the scan for an observer alone, once. Throws `Error`, also where no point takes part.
ScanCounts read_all(const ScanFiles& scan, RowObserver& observer);

}  // namespace lacuna::io
