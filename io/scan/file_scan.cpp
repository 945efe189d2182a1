// SPDX-License-Identifier: Apache-2.0
#include "io/scan/file_scan.hpp"

#include "engine/run/error.hpp"
#include "io/crs/crs_text.hpp"
#include "io/crs/length_unit.hpp"
#include "io/formats.hpp"
#include "io/rows/moved_reader.hpp"
#include "io/rows/vectors.hpp"
#include "io/scan/like_degrees.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <set>
#include <sstream>
#include <utility>

namespace lacuna::io {
namespace {

// Returns the first text of a file that is not empty, if the others are the same. Empty if two differ.
template <class Same>
std::string common(const std::vector<ScanFile>& files, std::string ScanFile::*text, const Same& is_same) {
  std::string first;
  for (const ScanFile& file : files) {
    if ((file.*text).empty()) continue;
    if (first.empty()) first = file.*text;
    if (!is_same(file.*text, first)) return "";
  }
  return first;
}

// The counts of a file that each pass makes anew.
template <class File>
auto pass_counts_of(File& file) {
  std::vector counts = {&file.rows_read, &file.nearer_to_zero, &file.nearer_to_scanner};
  for (const auto finding : kRowFindings) counts.push_back(&(file.findings.*finding));
  return counts;
}

void begin_pass(ScanFile& file) {
  for (std::uint64_t* count : pass_counts_of(file)) *count = 0;
}

}  // namespace

std::filesystem::path full_name(const std::filesystem::path& file) {
  return std::filesystem::absolute(file).lexically_normal();
}

ReadOptions read_options(const InputConfig& config, std::uint64_t memory) {
  return {.columns = config.columns,
          .memory = memory,
          .trust = config.trust,
          .skip_damaged = config.skip_damaged};
}

FileScan::FileScan(std::vector<ScanInput> inputs, InputConfig config, std::uint64_t memory)
    : config_(std::move(config)), memory_(memory), stated_(read_stated_crs(config_)) {
  for (ScanInput& input : inputs) add_file(std::move(input));
  choose_crs();
  choose_z_factors();
  last_file_ = files_.size();
}

void FileScan::add_file(ScanInput input) {
  ScanFile& file = files_.emplace_back();
  if (!input.arrays) file.state = file_state(input.file);
  file.name = std::move(input.file);
  file.pose = std::move(input.pose);
  file.arrays = std::move(input.arrays);
  const auto reader = open_in_own_units(files_.size() - 1);
  const RowFilter filter(config_, file.name, *reader);
  file.layout = reader->layout();
  file.crs = reader->crs();
  file.other_crs = reader->other_crs();
  add_units(*reader, file);
  file.format = reader->format();
  file.notes = reader->notes();
  file.has_scanner_at_zero = !file.pose && reader->has_scanner_at_zero();
  const std::vector<ScannerPose> scanners = reader->scanners();
  if (!file.pose && scanners.size() == 1 && !scanners[0].source) file.scanner = scanners[0].place;
  file.expected_rows = reader->expected_rows();
  file.is_geographic = reader->is_geographic();
  file.may_be_degrees =
      !file.is_geographic && file.crs.empty() && file.unit.empty() && look_like_degrees(*reader);
  reads_slowly_ = reads_slowly_ || reader->is_slow();
  has_normals_ = has_normals_ || has_vectors(file.layout, kNormalNames);
  has_scanners_ = has_scanners_ || !scanners.empty();
}

// The system states the units that a file does not, or contradicts them.
void FileScan::add_units(const ScanReader& reader, ScanFile& file) {
  file.unit = reader.length_unit();
  file.z_unit = reader.vertical_unit();
  const auto settle = [&](std::string& unit, const std::string& other, const char* what, const char* option) {
    if (unit.empty()) unit = other;
    if (other.empty() || other == unit || !file.contradiction.empty()) return;
    file.contradiction = std::string("its unit and its system contradict each other: ") + what + " are in " +
                         unit + " or in " + other + "; " + unit + " holds, and " + option + " " + other +
                         " states the other";
  };
  settle(file.unit, reader.other_unit(), "lengths", "--unit");
  const std::string& crs = file.crs;
  if (reader.is_geographic()) return;
  if (!is_code(crs)) return settle(file.unit, io::length_unit(crs), "lengths", "--unit");
  const bool has_z_code = crs.find('+') != crs.npos;
  if (is_utm(crs) && !has_z_code) return settle(file.unit, "m", "lengths", "--unit");
  // Files of one scan have one system, mostly, which is looked up once.
  if (crs != known_crs_) known_text_ = known_text(crs);
  known_crs_ = crs;
  settle(file.unit, io::length_unit(known_text_), "lengths", "--unit");
  settle(file.z_unit, vertical_unit(known_text_), "heights", "--unit-z");
}

// A stated unit of x and y that is not a file's own is a word against its unit of z, too.
void FileScan::choose_z_factors() {
  bool is_any = false;
  for (ScanFile& file : files_) {
    const std::string& flat = !stated_.unit.empty() ? stated_.unit
                              : file.unit.empty()   ? common_unit_
                                                    : file.unit;
    const std::string said = stated_.crs.empty() ? file.z_unit : vertical_unit(stated_.crs);
    if (!stated_.unit_z.empty()) {
      file.z_unit = stated_.unit_z;
    } else if (!stated_.unit.empty() && stated_.unit != file.unit) {
      file.z_unit.clear();
    }
    is_any = is_any || said != file.z_unit;
    const auto metres = metres_of_unit(flat), metres_of_z = metres_of_unit(file.z_unit);
    if (config_.unit_z != LengthUnit::kInput && !metres)
      throw Error(file.name.string() +
                  ": the unit of x and y is not known, into which --unit-z brings z; "
                  "--unit states it");
    if (flat == file.z_unit || !metres || !metres_of_z) file.z_unit.clear();
    file.z_factor = file.z_unit.empty() ? 1 : *metres_of_z / *metres;
    is_any = is_any || file.z_factor != 1;
  }
  // The results have z in other units than the vertical part of the system.
  if (is_any) common_crs_ = std::string(without_vertical(common_crs_));
}

void FileScan::choose_crs() {
  common_crs_ = stated_.crs.empty() ? common(files_, &ScanFile::crs, is_same_crs) : stated_.crs;
  if (!stated_.unit.empty()) {
    common_unit_ = stated_.unit;
    return;
  }
  const bool differ =
      common_crs_.empty() && std::ranges::any_of(files_, [](const ScanFile& f) { return !f.crs.empty(); });
  const bool all_have_one = std::ranges::none_of(files_, [](const ScanFile& f) { return f.unit.empty(); });
  if (!differ || all_have_one) common_unit_ = common(files_, &ScanFile::unit, std::equal_to<>());
}

std::unique_ptr<ScanReader> FileScan::open(std::size_t file) const {
  auto reader = open_in_own_units(file);
  const double factor = files_[file].z_factor;
  return factor == 1 ? std::move(reader) : with_z_times(std::move(reader), factor);
}

std::unique_ptr<ScanReader> FileScan::open_in_own_units(std::size_t index) const {
  const ScanFile& file = files_[index];
  if (file.arrays) return read_arrays(*file.arrays);
  io::check_unchanged(file.name, file.state);
  auto reader = open_scan(file.name, read_options(config_, memory_));
  return file.pose ? posed(std::move(reader), *file.pose) : std::move(reader);
}

std::size_t FileScan::batch_rows(std::size_t file) const {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 16;
  return std::clamp<std::uint64_t>(memory_ / 2 / files_[file].layout.stride, 1, kMost);
}

void FileScan::check_unchanged() const {
  for (const ScanFile& file : files_) {
    if (!file.arrays) io::check_unchanged(file.name, file.state);
  }
}

void FileScan::count_nearer(std::span<const Eigen::Vector3d> positions) {
  ScanFile& file = files_[file_];
  if (!file.scanner) return;
  for (const Eigen::Vector3d& position : positions) {
    const double from_zero = position.squaredNorm(), from_scanner = (position - *file.scanner).squaredNorm();
    file.nearer_to_zero += from_zero < from_scanner ? 1 : 0;
    file.nearer_to_scanner += from_zero > from_scanner ? 1 : 0;
  }
}

// The engine does so too, but knows no files.
void FileScan::refuse_too_far(const PointBatch& batch) const {
  const auto found = std::find_if(batch.positions.begin(), batch.positions.end(), is_too_far);
  if (found == batch.positions.end()) return;
  const std::uint64_t row =
      files_[file_].rows_read + static_cast<std::uint64_t>(found - batch.positions.begin());
  std::ostringstream message;
  message << files_[file_].name.string() << ": point " << row << " lies at " << found->x() << " "
          << found->y() << " " << found->z() << "; coordinates must be within 1e30";
  throw Error(message.str());
}

std::vector<std::uint64_t> FileScan::parts() const {
  constexpr std::uint64_t kBytesOfLine = 24;
  std::vector<std::uint64_t> parts;
  for (const ScanFile& file : files_)
    parts.push_back(file.expected_rows.value_or(file.state.size / kBytesOfLine));
  return parts;
}

void FileScan::select(std::size_t first, std::size_t last, PointId id) {
  first_file_ = first;
  last_file_ = last;
  first_id_ = id;
  for (ScanFile& file : files_) begin_pass(file);
}

void FileScan::rewind() {
  file_ = first_file_;
  next_id_ = value(first_id_);
  reader_.reset();
  filtered_out_ = {};
  before_filters_ = {};
  has_point_ = false;
  if (observer_) observer_->begin();
}

bool FileScan::next(PointBatch& batch) {
  batch.first = PointId{next_id_};
  batch.positions.clear();
  batch.normals.clear();
  for (; file_ < last_file_; ++file_, reader_.reset()) {
    if (!reader_) {
      reader_ = open(file_);
      begin_pass(files_[file_]);
      filter_.emplace(config_, files_[file_].name, *reader_);
    }
    if (!reader_->next(rows_, batch_rows(file_))) {
      files_[file_].findings = reader_->findings();
      continue;
    }
    const RowLayout& layout = reader_->layout();
    load_vectors(rows_, layout, kPositionNames, batch.positions);
    count_nearer(batch.positions);
    if (observer_) read_ = batch.positions;
    filter_->apply(rows_, batch.positions, filtered_out_, before_filters_);
    if (observer_) observer_->take(file_, *reader_, rows_, read_, batch.positions);
    if (has_vectors(layout, kNormalNames)) {
      load_vectors(rows_, layout, kNormalNames, batch.normals);
    } else if (has_normals_) {
      batch.normals.assign(rows_.count, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
    refuse_too_far(batch);
    has_point_ = has_point_ || std::any_of(batch.positions.begin(), batch.positions.end(),
                                           [](const Eigen::Vector3d& p) { return p.allFinite(); });
    files_[file_].rows_read += rows_.count;
    next_id_ += rows_.count;
    return true;
  }
  if (last_file_ - first_file_ < files_.size()) return false;  // other files may have points
  if (filtered_out_.total() > 0 && !has_point_)
    throw Error(describe_no_row_left(config_, filtered_out_, before_filters_));
  if (!has_point_ && !files_.empty() && !files_[0].arrays) throw Error(describe_no_point());
  if (observer_) observer_->end();
  return false;
}

std::string FileScan::describe_no_point() const {
  std::uint64_t rows = 0;
  for (const ScanFile& file : files_) rows += file.rows_read;
  const std::string name = files_[0].name.string() + (files_.size() > 1 ? " and the other files" : "");
  if (rows == 0) return name + ": no points: a header alone, or empty scans";
  return name + ": no points: none of " + std::to_string(rows) +
         " rows has a place; they are NaN, or rays that are marked as invalid or have no return";
}

void FileScan::read_all(RowObserver& observer) {
  observe(&observer);
  rewind();
  PointBatch batch;
  while (next(batch)) {
  }
  observe(nullptr);
}

std::optional<std::uint64_t> FileScan::expected_points() const {
  std::uint64_t points = 0;
  for (const ScanFile& file : files_) {
    if (!file.expected_rows) return std::nullopt;
    points += *file.expected_rows;
  }
  return points;
}

std::vector<std::string> FileScan::identity() const {
  std::vector<std::string> lines;
  if (std::ranges::any_of(files_, [](const ScanFile& file) { return file.arrays != nullptr; })) return lines;
  const std::vector<std::string> names = this->names();
  for (std::size_t i = 0; i < files_.size(); ++i) {
    std::ostringstream line;
    const FileState& state = files_[i].state;
    const Digest sample = sample_digest(files_[i].name, state);
    line << names[3 * i + 1] << ", " << state.size << " bytes, written at " << state.mtime << " ns, sample "
         << std::hex << sample[0] << sample[1];
    if (files_[i].pose) line << ", pose " << names[3 * i + 2];
    lines.push_back(line.str());
  }
  FilesConfig config;
  config.input = config_;
  for (const Parameter& p : file_parameters(config)) {
    if (p.changes == Changes::kPoints) lines.push_back(std::string(p.key) + " = " + p.print());
  }
  if (!stated_.crs.empty()) {  // a file counts by its content
    std::ostringstream line;
    line << "text of crs = " << std::hex << digest_of(stated_.crs)[0];
    lines.push_back(line.str());
  }
  return lines;
}

std::vector<std::string> FileScan::names() const {
  std::vector<std::string> names;
  for (const ScanFile& file : files_) {
    std::ostringstream pose;
    if (file.pose) pose << file.pose->matrix().format(Eigen::IOFormat(17, Eigen::DontAlignCols, " ", " "));
    names.insert(names.end(), {file.name.string(), full_name(file.name).string(), pose.str()});
  }
  return names;
}

std::vector<ScanInput> inputs_of(std::span<const std::string> names) {
  std::vector<ScanInput> inputs;
  if (names.size() % 3 != 0) fail_inconsistent("an input of a workspace has no name");
  for (; !names.empty(); names = names.subspan(3)) {
    const std::string& file = full_name(names[0]) == names[1] ? names[0] : names[1];
    inputs.emplace_back(file, names[2].empty() ? std::nullopt : std::optional(parse_pose(names[2])));
  }
  return inputs;
}

std::vector<std::uint64_t> FileScan::pass_counts() const {
  std::vector<std::uint64_t> counts;
  for (const ScanFile& file : files_) {
    for (const std::uint64_t* count : pass_counts_of(file)) counts.push_back(*count);
  }
  for (const FilterCount& filter : kFilterCounts) counts.push_back(filtered_out_.*filter.count);
  counts.push_back(filtered_out_.synthetic);
  return counts;
}

void FileScan::set_pass_counts(std::span<const std::uint64_t> counts) {
  if (counts.size() != pass_counts().size())
    fail_inconsistent("the workspace counts another number of files");
  auto count = counts.begin();
  for (ScanFile& file : files_) {
    for (std::uint64_t* of_file : pass_counts_of(file)) *of_file = *count++;
  }
  for (const FilterCount& filter : kFilterCounts) filtered_out_.*filter.count = *count++;
  filtered_out_.synthetic = *count;
}

std::vector<RowLayout> layouts_of(const FileScan& scan) {
  std::vector<RowLayout> layouts;
  for (const ScanFile& file : scan.files()) layouts.push_back(file.layout);
  return layouts;
}

std::vector<std::filesystem::path> names_of(const FileScan& scan) {
  std::vector<std::filesystem::path> names;
  for (const ScanFile& file : scan.files()) names.push_back(file.name);
  return names;
}

bool has_single_precision(const FileScan& scan) {
  return std::ranges::all_of(scan.files(), [](const ScanFile& file) {
    return std::ranges::all_of(
        kPositionNames, [&](const char* name) { return file.layout.find(name)->type == Scalar::kFloat32; });
  });
}

std::vector<std::size_t> repeated_files(const FileScan& scan) {
  std::set<FileIdentity> seen;
  std::vector<std::size_t> repeated;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    const ScanFile& file = scan.files()[i];
    if (!file.arrays && !seen.emplace(file.state.device, file.state.inode).second) repeated.push_back(i);
  }
  return repeated;
}

void check_not_input(const ResultFolder& folder, const FileScan& scan) {
  for (const std::filesystem::path& earlier : folder.earlier_files()) {
    const std::optional<FileIdentity> identity = find_identity(earlier);
    for (const ScanFile& file : scan.files()) {
      if (!file.arrays && identity == FileIdentity(file.state.device, file.state.inode))
        throw Error(file.name.string() +
                    ": is an input in the place of a result; another output folder is needed");
    }
  }
}

}  // namespace lacuna::io
