// SPDX-License-Identifier: Apache-2.0
// Several scan files, or arrays, as one registered scan: what they are, how each is opened, and whether two
// are one.
#pragma once

#include "engine/export.hpp"
#include "io/read/crs/crs.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/formats.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// A scan in the memory of another program, as a file of rows.

// A scalar of every row, at any stride.
struct ScanColumn {
  std::string name;
  Scalar type;
  const std::byte* first;
  std::ptrdiff_t stride;  // bytes from row to row
};

// The struct does not own the columns.
struct ScanArrays {
  std::uint64_t rows = 0;
  std::vector<ScanColumn> columns;  // x, y and z among them
};

// `arrays` must outlive the reader. Columns are copied row by row.
LACUNA_API std::unique_ptr<ScanReader> read_arrays(const ScanArrays& arrays);

// Several scan files, or arrays, as one registered scan: what they are, and how each is opened.

struct ScanInput {
  template <std::convertible_to<std::filesystem::path> Name>
  ScanInput(Name&& name, std::optional<Pose> pose = {})
      : name(std::forward<Name>(name)), pose(std::move(pose)) {}
  ScanInput(std::string name, ScanArrays arrays)
      : name(std::move(name)), arrays(std::make_shared<const ScanArrays>(std::move(arrays))) {}

  std::filesystem::path name;                // as given
  std::optional<Pose> pose;                  // of its coordinates in the registered scan
  std::shared_ptr<const ScanArrays> arrays;  // read in place of a file, of which it has the name
};

// A file of a scan, or arrays, as they were opened first.
struct ScanFile : ScanInput {
  FileState state;               // of a file on disk
  std::optional<Format> format;  // likewise
  RowLayout layout;
  std::vector<ReaderNote> notes;  // of its reader
  std::string crs;                // empty if it names none, or has a pose
  std::string other_crs;          // that its records name as well; empty if they do not
  std::string unit;               // of length; empty if neither it nor its system names one
  std::string other_unit;         // that it states as well; empty if it does not
  std::string z_unit;             // of z, with what --unit-z states; empty if it is the unit of x and y
  std::string contradiction;      // how the units that it states contradict each other; empty if they do not
  double z_factor = 1;            // brings its z into the unit of x and y
  bool is_geographic = false;     // longitude and latitude, as its system or the names of its columns say
  bool may_be_degrees = false;    // its first rows look like them, and it says nothing of units
  bool has_scanner_at_zero = false;            // it states 0 0 0 as its scanner's place, and no pose moves it
  std::optional<Eigen::Vector3d> scanner;      // else its only scanner's place, if no pose moves it
  std::optional<std::uint64_t> expected_rows;  // as its header declares; text declares none
};

// What holds for all files of a scan.
struct CommonSystem {
  // The system that the config states, else the one that all files with a system share. It is empty if the
  // systems differ, or if no file names one.
  std::string crs;
  // The unit of length that the config states, else the one that all files with a unit share. It is empty if
  // units differ, or there are none. It is empty, too, if files have different systems and one has no unit.
  std::string unit;
};

// Returns how the files of a scan with these parameters are read, within so many bytes.
LACUNA_API ReadOptions read_options(const InputConfig& config, std::uint64_t memory);

class LACUNA_API ScanFiles {
 public:
  // Opens every file once. So a missing or broken file, or one that lacks what a filter needs, is an `Error`
  // before any work is done. Reading takes `memory` bytes at most, but for a row. Batches have fewer rows
  // where these are long.
  ScanFiles(std::vector<ScanInput> inputs, InputConfig config, std::uint64_t memory = ReadOptions{}.memory);

  const std::vector<ScanFile>& files() const { return files_; }
  const InputConfig& config() const { return config_; }
  std::uint64_t memory() const { return memory_; }
  // Returns the values of --crs and --unit in the config; empty if not stated.
  const StatedCrs& stated_crs() const { return stated_; }
  const std::string& common_crs() const { return common_.crs; }
  const std::string& length_unit() const { return common_.unit; }
  bool has_normals() const { return has_normals_; }    // any file has nx ny nz
  bool reads_slowly() const { return reads_slowly_; }  // any file does
  bool has_scanners() const { return has_scanners_; }  // a file has the place of one
  // Returns the rows of all files, where all headers declare them.
  std::optional<std::uint64_t> expected_points() const;
  // Returns how many rows of a file to read at a time.
  std::size_t batch_rows(std::size_t file) const;

  // Opens a file at its first row, moved by its pose, without filters, with z in the unit of x and y. Throws
  // `Error` if the file has changed since the first opening.
  std::unique_ptr<ScanReader> open(std::size_t file) const;
  // Opens it likewise with z in its own unit, which results for each point have.
  std::unique_ptr<ScanReader> open_in_own_units(std::size_t file) const;
  // Throws `Error` if a file is no longer what it was when it was first opened. Then a later read may not fit
  // an earlier one.
  void check_unchanged() const;

 private:
  void add_file(ScanInput input);

  std::vector<ScanFile> files_;
  InputConfig config_;
  std::uint64_t memory_;
  StatedCrs stated_;
  CommonSystem common_;
  bool has_normals_ = false, reads_slowly_ = false, has_scanners_ = false;
};

std::vector<RowLayout> layouts_of(const ScanFiles& scan);            // one per file
std::vector<std::filesystem::path> names_of(const ScanFiles& scan);  // likewise
// Returns the rows of each file as its header declares. For text, they are as many as short lines allow.
std::vector<std::uint64_t> estimated_rows(const ScanFiles& scan);
bool has_single_precision(const ScanFiles& scan);  // x, y and z are 32-bit floats in every file

// Which files a scan has: whether another run has the same, and whether two of them are one.

// Returns name, size, time and a sample of each file, its pose, and the parameters of input, a line each.
// Returns nothing if there are arrays. Throws `Error`.
std::vector<std::string> identity_of(const ScanFiles& scan);

// Returns three texts for each file: its name as given, the absolute one, and its pose or nothing.
std::vector<std::string> kept_names(const ScanFiles& scan);
// Returns the inputs that have these names. A name is as it was given, if it names the same file from here.
LACUNA_API std::vector<ScanInput> inputs_of(std::span<const std::string> kept_names);

// Returns the inputs that are the same file as one before them, ascending.
std::vector<std::size_t> repeated_files(const ScanFiles& scan);

// Throws `Error` if an earlier result that the folder replaces is an input of the scan.
void check_not_input(const ResultFolder& folder, const ScanFiles& scan);

// Whether positions have the look of longitude and latitude.

// Returns whether x and y may be degrees of one survey, in either order, with heights in a unit of length.
// This is a guess: lengths may look the same. All of these hold:
// - One of x and y is within 90, the other one within 360. Both extend over less than 3, and both have five
//   decimals or more. One of them is farther from 0 than ten times its extent.
// - z extends a hundred times as far as x and y. It is enough that z extends as far as they do, where it has
//   two decimals at most.
// Fewer than ten positions say nothing.
bool look_like_degrees(std::span<const Eigen::Vector3d> positions);

// Reads the first rows, at most 4,096.
bool look_like_degrees(ScanReader& reader);

// Whether x and y of a scan are its plan, and where on Earth it lies.

// Returns a position of a file that is likely to be one of its surface; nothing if its first rows have none.
std::optional<Eigen::Vector3d> find_place(const ScanFiles& scan, std::size_t file);

// Returns the system in which the user can work instead, such as "EPSG:32632".
std::string utm_zone(double longitude, double latitude);

// Throws `Error` where a file is geocentric, with the way to a projected system; `option` needs the plan. Its
// system says so. Without a system and a unit, its first position says so: the distance from 0 0 0 is a
// radius of the Earth in metres.
void require_plan(const ScanFiles& scan, const std::string& option);

}  // namespace lacuna::io
