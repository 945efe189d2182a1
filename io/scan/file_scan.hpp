// SPDX-License-Identifier: Apache-2.0
// Several scan files, or arrays, as one registered scan: the engine's view of the input.
#pragma once

#include "engine/export.hpp"
#include "engine/model/points.hpp"
#include "io/crs/stated_crs.hpp"
#include "io/files/file_state.hpp"
#include "io/files/result_folder.hpp"
#include "io/rows/pose.hpp"
#include "io/rows/scan_reader.hpp"
#include "io/scan/row_filter.hpp"
#include "io/scan/scan_arrays.hpp"

#include <concepts>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lacuna::io {

struct ScanInput {
  template <std::convertible_to<std::filesystem::path> Name>
  ScanInput(Name&& name, std::optional<Pose> pose = {})
      : file(std::forward<Name>(name)), pose(std::move(pose)) {}
  ScanInput(std::string name, ScanArrays arrays)
      : file(std::move(name)), arrays(std::make_shared<const ScanArrays>(std::move(arrays))) {}

  std::filesystem::path file;
  std::optional<Pose> pose;                  // of its coordinates in the registered scan
  std::shared_ptr<const ScanArrays> arrays;  // read in place of a file, of which it has the name
};

LACUNA_API std::filesystem::path full_name(const std::filesystem::path& file);  // absolute, without dots
// The inputs that have these `FileScan::names`. A name as it was given, if it names the same file from here.
LACUNA_API std::vector<ScanInput> inputs_of(std::span<const std::string> names);

// Returns how the files of a scan with these parameters are read, within so many bytes.
LACUNA_API ReadOptions read_options(const InputConfig& config, std::uint64_t memory);

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

// Ids count the rows over the files, in order. A batch lies within one file. If any file has normals, the
// points of a file without normals get NaN. Points that the filters of the config leave out have NaN for a
// position. If they leave out all points, the last `next` is an `Error`. A file that changes after the first
// opening is an `Error` when it is opened again.
class LACUNA_API FileScan : public PointSource {
 public:
  // Opens every file once. So a missing or broken file, or one that lacks what a filter needs, is an `Error`
  // before any work is done. Reading takes `memory` bytes at most, but for a row. Batches have fewer rows
  // where these are long.
  FileScan(std::vector<ScanInput> inputs, InputConfig config, std::uint64_t memory = ReadOptions{}.memory);

  void rewind() override;
  bool next(PointBatch& batch) override;
  std::optional<std::uint64_t> expected_points() const override;
  bool has_normals() const override;   // any file has nx ny nz
  bool reads_slowly() const override;  // any file does
  // Returns the rows of each file as its header declares. For text, they are as many as short lines allow.
  std::vector<std::uint64_t> parts() const override;
  void select(std::size_t first, std::size_t last, PointId id) override;
  // Returns name, size, time and a sample of each file, its pose, and the parameters of input. Returns
  // nothing if there are arrays.
  std::vector<std::string> identity() const override;
  // Returns three texts for each file: its name as given, the absolute one, and its pose or nothing.
  std::vector<std::string> names() const override;
  // Returns the rows that were read of each file, the rows that the filters left out, and synthetic ones.
  std::vector<std::uint64_t> pass_counts() const override;
  void set_pass_counts(std::span<const std::uint64_t> counts) override;

  const std::vector<std::filesystem::path>& files() const { return files_; }
  const std::vector<std::optional<Pose>>& poses() const { return poses_; }  // one per file
  const std::vector<RowLayout>& layouts() const { return layouts_; }        // one per file
  // Returns the rows that each file's header declares; text files declare none.
  const std::vector<std::optional<std::uint64_t>>& expected_rows() const { return expected_rows_; }
  // Returns the format of each file, as ScanReader::format says.
  const std::vector<std::string>& formats() const { return formats_; }
  // Returns what each file's reader notes.
  const std::vector<std::vector<ReaderNote>>& notes() const { return notes_; }
  // Whether a file states 0 0 0 as its scanner's place, and no pose moves it.
  bool has_scanner_at_zero(std::size_t file) const { return has_scanner_at_zero_[file]; }
  // Returns the CRS of each file; empty if it names none, or has a pose.
  const std::vector<std::string>& crs() const { return crs_; }
  // Returns the unit of length of each file; empty if it names none.
  const std::vector<std::string>& units() const { return units_; }
  // Returns the unit of z of each file, with what --unit-z states; empty if it is the unit of x and y.
  const std::vector<std::string>& z_units() const { return z_units_; }
  // Returns how the units that each file states contradict each other; empty if they do not.
  const std::vector<std::string>& contradictions() const { return contradictions_; }
  // Returns the factor that brings z of a file into the unit of x and y.
  double z_factor(std::size_t file) const { return z_factors_[file]; }
  // Whether positions of a file are longitude and latitude, as it says, or as its first rows show where it
  // names no system.
  bool is_geographic(std::size_t file) const { return is_geographic_[file]; }
  // Returns the values of --crs and --unit in the config; empty if not stated.
  const StatedCrs& stated_crs() const { return stated_; }
  // Returns the system that the config states, else the one that all files with a system share. It is empty
  // if the systems differ, or if no file names one.
  const std::string& common_crs() const { return common_crs_; }
  // Returns the unit of length that the config states, else the one that all files with a unit share. It is
  // empty if units differ, or there are none. It is empty, too, if files have different systems and one has
  // no unit.
  const std::string& length_unit() const { return common_unit_; }
  // Returns the rows of a file: as its header declares, else as many as the last pass has read of it.
  std::uint64_t rows(std::size_t file) const { return expected_rows_[file].value_or(rows_read_[file]); }
  std::uint64_t memory() const { return memory_; }
  // Returns how many rows of a file to read at a time.
  std::size_t batch_rows(std::size_t file) const;
  // Opens a file at its first row, moved by its pose, without filters, with z in the unit of x and y.
  std::unique_ptr<ScanReader> open(std::size_t file) const;
  // Opens it likewise with z in its own unit, which results for each point have.
  std::unique_ptr<ScanReader> open_in_own_units(std::size_t file) const;
  // Counts the points read since the last rewind.
  const FilteredOut& filtered_out() const { return filtered_out_; }
  // Throws `Error` if a file is no longer what it was when it was first opened. Then a later read may not fit
  // an earlier one.
  void check_unchanged() const;
  // Returns the first input that is this file, by whatever name; nothing if none is.
  std::optional<std::size_t> find(const std::filesystem::path& file) const;
  // Returns the inputs that are the same file as one before them, ascending.
  std::vector<std::size_t> repeated() const;
  void observe(RowObserver* observer) { observer_ = observer; }  // null: no observer
  void read_all(RowObserver& observer);                          // for this observer alone, once
  bool has_scanners() const { return has_scanners_; }            // a file has the place of one
  bool single_precision() const;                                 // x, y and z are 32-bit floats in every file

 private:
  void choose_crs();
  void add_units(const ScanReader& reader);
  void choose_z_factors();
  void refuse_too_far(const PointBatch& batch) const;
  std::string describe_no_point() const;

  std::vector<std::filesystem::path> files_;
  std::vector<std::optional<Pose>> poses_;                 // one per file
  std::vector<std::shared_ptr<const ScanArrays>> arrays_;  // one per file; null for a file on disk
  InputConfig config_;
  std::uint64_t memory_;
  std::vector<FileState> states_;                 // of each file; nothing for arrays
  std::map<FileIdentity, std::size_t> first_of_;  // the first input of each file
  std::vector<RowLayout> layouts_;
  std::vector<std::string> crs_, units_, z_units_, contradictions_, formats_;
  std::vector<double> z_factors_;
  std::vector<std::vector<ReaderNote>> notes_;
  std::vector<bool> is_geographic_, has_scanner_at_zero_;
  StatedCrs stated_;
  std::string known_crs_;  // well-known text of the last code that was looked up
  std::string common_crs_, common_unit_;
  bool has_normals_ = false, reads_slowly_ = false, has_scanners_ = false;
  std::vector<std::optional<std::uint64_t>> expected_rows_;
  std::optional<std::uint64_t> expected_points_;
  std::vector<std::uint64_t> rows_read_;    // of each file, in this pass
  std::size_t first_file_ = 0, last_file_;  // that passes read
  PointId first_id_{};
  // where reading goes on
  std::size_t file_ = 0;
  std::uint64_t next_id_ = 0;
  std::unique_ptr<ScanReader> reader_;
  std::optional<RowFilter> filter_;
  RowBatch rows_;
  FilteredOut filtered_out_;
  BeforeFilters before_filters_;
  bool has_point_ = false;  // a finite one was there in this pass
  RowObserver* observer_ = nullptr;
  std::vector<Eigen::Vector3d> read_;  // positions before the filters, for the observer
};

// Throws `Error` if an earlier result that the folder replaces is an input of the scan.
void check_not_input(const ResultFolder& folder, const FileScan& scan);

}  // namespace lacuna::io
