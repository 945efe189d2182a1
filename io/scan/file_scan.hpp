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

// A file of a scan, or arrays, as they were opened first.
struct ScanFile {
  std::filesystem::path name;                // as given
  std::optional<Pose> pose;                  // of its coordinates in the registered scan
  std::shared_ptr<const ScanArrays> arrays;  // null for a file on disk
  FileState state;                           // of a file on disk
  std::string format;                        // as `ScanReader::format` says
  RowLayout layout;
  std::vector<ReaderNote> notes;  // of its reader
  std::string crs;                // empty if it names none, or has a pose
  std::string other_crs;          // that its records name as well; empty if they do not
  std::string unit;               // of length; empty if it names none
  std::string z_unit;             // of z, with what --unit-z states; empty if it is the unit of x and y
  std::string contradiction;      // how the units that it states contradict each other; empty if they do not
  double z_factor = 1;            // brings its z into the unit of x and y
  bool is_geographic = false;     // longitude and latitude, as its system or the names of its columns say
  bool may_be_degrees = false;    // its first rows look like them, and it says nothing of units
  bool has_scanner_at_zero = false;        // it states 0 0 0 as its scanner's place, and no pose moves it
  std::optional<Eigen::Vector3d> scanner;  // else its only scanner's place, if no pose moves it
  // In the last pass: points that are nearer to 0 0 0 than to that scanner, and the others.
  std::uint64_t nearer_to_zero = 0, nearer_to_scanner = 0;
  RowFindings findings;                        // in the last pass
  std::optional<std::uint64_t> expected_rows;  // as its header declares; text declares none
  std::uint64_t rows_read = 0;                 // in the last pass

  std::uint64_t rows() const { return expected_rows.value_or(rows_read); }
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
  bool has_normals() const override { return has_normals_; }    // any file has nx ny nz
  bool reads_slowly() const override { return reads_slowly_; }  // any file does
  // Returns the rows of each file as its header declares. For text, they are as many as short lines allow.
  std::vector<std::uint64_t> parts() const override;
  void select(std::size_t first, std::size_t last, PointId id) override;
  // Returns name, size, time and a sample of each file, its pose, and the parameters of input. Returns
  // nothing if there are arrays.
  std::vector<std::string> identity() const override;
  // Returns three texts for each file: its name as given, the absolute one, and its pose or nothing.
  std::vector<std::string> names() const override;
  // Returns what was counted in each file, the rows that the filters left out, and synthetic ones.
  std::vector<std::uint64_t> pass_counts() const override;
  void set_pass_counts(std::span<const std::uint64_t> counts) override;

  const std::vector<ScanFile>& files() const { return files_; }
  // Returns the values of --crs and --unit in the config; empty if not stated.
  const StatedCrs& stated_crs() const { return stated_; }
  // Returns the system that the config states, else the one that all files with a system share. It is empty
  // if the systems differ, or if no file names one.
  const std::string& common_crs() const { return common_crs_; }
  // Returns the unit of length that the config states, else the one that all files with a unit share. It is
  // empty if units differ, or there are none. It is empty, too, if files have different systems and one has
  // no unit.
  const std::string& length_unit() const { return common_unit_; }
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
  void observe(RowObserver* observer) { observer_ = observer; }  // null: no observer
  void read_all(RowObserver& observer);                          // for this observer alone, once
  bool has_scanners() const { return has_scanners_; }            // a file has the place of one

 private:
  void add_file(ScanInput input);
  void add_units(const ScanReader& reader, ScanFile& file);
  void choose_crs();
  void choose_z_factors();
  void count_nearer(std::span<const Eigen::Vector3d> positions);
  void refuse_too_far(const PointBatch& batch) const;
  std::string describe_no_point() const;

  std::vector<ScanFile> files_;
  InputConfig config_;
  std::uint64_t memory_;
  StatedCrs stated_;
  std::string known_crs_, known_text_;  // the last code that was looked up, and its well-known text
  std::string common_crs_, common_unit_;
  bool has_normals_ = false, reads_slowly_ = false, has_scanners_ = false;
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

std::vector<RowLayout> layouts_of(const FileScan& scan);            // one per file
std::vector<std::filesystem::path> names_of(const FileScan& scan);  // likewise
bool has_single_precision(const FileScan& scan);  // x, y and z are 32-bit floats in every file
// Returns the inputs that are the same file as one before them, ascending.
std::vector<std::size_t> repeated_files(const FileScan& scan);

// Throws `Error` if an earlier result that the folder replaces is an input of the scan.
void check_not_input(const ResultFolder& folder, const FileScan& scan);

}  // namespace lacuna::io
