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
#include <sstream>
#include <utility>

namespace lacuna::io {
namespace {

// Returns the first text that is not empty, if the others are the same. Empty if two differ.
template <class Same>
std::string common(const std::vector<std::string>& names, const Same& is_same) {
  std::string first;
  for (const std::string& name : names) {
    if (name.empty()) continue;
    if (first.empty()) first = name;
    if (!is_same(name, first)) return "";
  }
  return first;
}

}  // namespace

std::filesystem::path full_name(const std::filesystem::path& file) {
  return std::filesystem::absolute(file).lexically_normal();
}

ReadOptions read_options(const InputConfig& config, std::uint64_t memory) {
  return {.columns = config.columns, .memory = memory, .trust = config.trust};
}

FileScan::FileScan(std::vector<ScanInput> inputs, InputConfig config, std::uint64_t memory)
    : config_(std::move(config)), memory_(memory), stated_(read_stated_crs(config_)), expected_points_(0) {
  for (ScanInput& input : inputs) {
    states_.push_back(input.arrays ? FileState() : file_state(input.file));
    if (!input.arrays)
      first_of_.emplace(FileIdentity(states_.back().device, states_.back().inode), states_.size() - 1);
    arrays_.push_back(std::move(input.arrays));
    files_.push_back(std::move(input.file));
    poses_.push_back(std::move(input.pose));
    const auto reader = open_in_own_units(files_.size() - 1);
    const RowFilter filter(config_, files_.back(), *reader);
    layouts_.push_back(reader->layout());
    crs_.push_back(reader->crs());
    add_units(*reader);
    formats_.push_back(reader->format());
    notes_.push_back(reader->notes());
    has_scanner_at_zero_.push_back(!poses_.back() && reader->has_scanner_at_zero());
    reads_slowly_ = reads_slowly_ || reader->is_slow();
    has_normals_ = has_normals_ || has_vectors(layouts_.back(), kNormalNames);
    has_scanners_ = has_scanners_ || !reader->scanners().empty();
    rows_read_.push_back(0);
    expected_rows_.push_back(reader->expected_rows());
    if (expected_points_ && expected_rows_.back()) {
      *expected_points_ += *expected_rows_.back();
    } else {
      expected_points_.reset();
    }
    is_geographic_.push_back(reader->is_geographic() || (crs_.back().empty() && look_like_degrees(*reader)));
  }
  choose_crs();
  choose_z_factors();
  last_file_ = files_.size();
}

// The system states the units that a file does not, or contradicts them.
void FileScan::add_units(const ScanReader& reader) {
  units_.push_back(reader.length_unit());
  z_units_.push_back(reader.vertical_unit());
  std::string& contradiction = contradictions_.emplace_back();
  const auto settle = [&](std::string& unit, const std::string& other, const char* what, const char* option) {
    if (unit.empty()) unit = other;
    if (other.empty() || other == unit || !contradiction.empty()) return;
    contradiction = std::string("its unit and its system contradict each other: ") + what + " are in " +
                    unit + " or in " + other + "; " + unit + " holds, and " + option + " " + other +
                    " states the other";
  };
  settle(units_.back(), reader.other_unit(), "lengths", "--unit");
  const std::string& crs = crs_.back();
  if (reader.is_geographic()) return;
  if (!is_code(crs)) return settle(units_.back(), io::length_unit(crs), "lengths", "--unit");
  const bool has_z_code = crs.find('+') != crs.npos;
  if (is_utm(crs) && !has_z_code) return settle(units_.back(), "m", "lengths", "--unit");
  // Files of one scan have one system, mostly, which is looked up once.
  if (crs_.size() < 2 || crs != crs_[crs_.size() - 2]) known_crs_.clear();
  if (known_crs_.empty()) known_crs_ = known_text(crs);
  settle(units_.back(), io::length_unit(known_crs_), "lengths", "--unit");
  settle(z_units_.back(), vertical_unit(known_crs_), "heights", "--unit-z");
}

// A stated unit of x and y that is not a file's own is a word against its unit of z, too.
void FileScan::choose_z_factors() {
  bool is_any = false;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const std::string& flat = !stated_.unit.empty() ? stated_.unit
                              : units_[i].empty()   ? common_unit_
                                                    : units_[i];
    const std::string said = stated_.crs.empty() ? z_units_[i] : vertical_unit(stated_.crs);
    if (!stated_.unit_z.empty()) {
      z_units_[i] = stated_.unit_z;
    } else if (!stated_.unit.empty() && stated_.unit != units_[i]) {
      z_units_[i].clear();
    }
    is_any = is_any || said != z_units_[i];
    const auto metres = metres_of_unit(flat), metres_of_z = metres_of_unit(z_units_[i]);
    if (config_.unit_z != LengthUnit::kInput && !metres)
      throw Error(files_[i].string() +
                  ": the unit of x and y is not known, into which --unit-z brings z; "
                  "--unit states it");
    if (flat == z_units_[i] || !metres || !metres_of_z) z_units_[i].clear();
    z_factors_.push_back(z_units_[i].empty() ? 1 : *metres_of_z / *metres);
    is_any = is_any || z_factors_.back() != 1;
  }
  // The results have z in other units than the vertical part of the system.
  if (is_any) common_crs_ = std::string(without_vertical(common_crs_));
}

void FileScan::choose_crs() {
  common_crs_ = stated_.crs.empty() ? common(crs_, is_same_crs) : stated_.crs;
  if (!stated_.unit.empty()) {
    common_unit_ = stated_.unit;
    return;
  }
  const bool differ = common_crs_.empty() && std::any_of(crs_.begin(), crs_.end(),
                                                         [](const std::string& crs) { return !crs.empty(); });
  const bool all_have_one =
      std::none_of(units_.begin(), units_.end(), [](const std::string& unit) { return unit.empty(); });
  if (!differ || all_have_one) common_unit_ = common(units_, std::equal_to<>());
}

std::unique_ptr<ScanReader> FileScan::open(std::size_t file) const {
  auto reader = open_in_own_units(file);
  const double factor = z_factors_[file];
  return factor == 1 ? std::move(reader) : with_z_times(std::move(reader), factor);
}

std::unique_ptr<ScanReader> FileScan::open_in_own_units(std::size_t file) const {
  if (arrays_[file]) return read_arrays(*arrays_[file]);
  io::check_unchanged(files_[file], states_[file]);
  auto reader = open_scan(files_[file], read_options(config_, memory_));
  return poses_[file] ? posed(std::move(reader), *poses_[file]) : std::move(reader);
}

std::size_t FileScan::batch_rows(std::size_t file) const {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 16;
  return std::clamp<std::uint64_t>(memory_ / 2 / layouts_[file].stride, 1, kMost);
}

void FileScan::check_unchanged() const {
  for (std::size_t i = 0; i < files_.size(); ++i) {
    if (!arrays_[i]) io::check_unchanged(files_[i], states_[i]);
  }
}

// The engine does so too, but knows no files.
void FileScan::refuse_too_far(const PointBatch& batch) const {
  const auto found = std::find_if(batch.positions.begin(), batch.positions.end(), is_too_far);
  if (found == batch.positions.end()) return;
  const std::uint64_t row = rows_read_[file_] + static_cast<std::uint64_t>(found - batch.positions.begin());
  std::ostringstream message;
  message << files_[file_].string() << ": point " << row << " lies at " << found->x() << " " << found->y()
          << " " << found->z() << "; coordinates must be within 1e153";
  throw Error(message.str());
}

std::vector<std::uint64_t> FileScan::parts() const {
  constexpr std::uint64_t kBytesOfLine = 24;
  std::vector<std::uint64_t> parts;
  for (std::size_t file = 0; file < files_.size(); ++file)
    parts.push_back(expected_rows_[file].value_or(states_[file].size / kBytesOfLine));
  return parts;
}

void FileScan::select(std::size_t first, std::size_t last, PointId id) {
  first_file_ = first;
  last_file_ = last;
  first_id_ = id;
  std::fill(rows_read_.begin(), rows_read_.end(), 0);
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
      rows_read_[file_] = 0;
      filter_.emplace(config_, files_[file_], *reader_);
    }
    if (!reader_->next(rows_, batch_rows(file_))) continue;
    const RowLayout& layout = reader_->layout();
    load_vectors(rows_, layout, kPositionNames, batch.positions);
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
    rows_read_[file_] += rows_.count;
    next_id_ += rows_.count;
    return true;
  }
  if (last_file_ - first_file_ < files_.size()) return false;  // other files may have points
  if (filtered_out_.total() > 0 && !has_point_)
    throw Error(describe_no_row_left(config_, filtered_out_, before_filters_));
  if (!has_point_ && !files_.empty() && !arrays_[0]) throw Error(describe_no_point());
  if (observer_) observer_->end();
  return false;
}

std::string FileScan::describe_no_point() const {
  std::uint64_t rows = 0;
  for (const std::uint64_t count : rows_read_) rows += count;
  const std::string name = files_[0].string() + (files_.size() > 1 ? " and the other files" : "");
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
  return expected_points_;
}

bool FileScan::has_normals() const {
  return has_normals_;
}

bool FileScan::reads_slowly() const {
  return reads_slowly_;
}

std::vector<std::string> FileScan::identity() const {
  std::vector<std::string> lines;
  if (std::any_of(arrays_.begin(), arrays_.end(), std::identity())) return lines;
  const std::vector<std::string> names = this->names();
  for (std::size_t i = 0; i < files_.size(); ++i) {
    std::ostringstream line;
    const Digest sample = sample_digest(files_[i], states_[i]);
    line << names[3 * i + 1] << ", " << states_[i].size << " bytes, written at " << states_[i].mtime
         << " ns, sample " << std::hex << sample[0] << sample[1];
    if (poses_[i]) line << ", pose " << names[3 * i + 2];
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
  for (std::size_t i = 0; i < files_.size(); ++i) {
    std::ostringstream pose;
    if (poses_[i]) pose << poses_[i]->matrix().format(Eigen::IOFormat(17, Eigen::DontAlignCols, " ", " "));
    names.insert(names.end(), {files_[i].string(), full_name(files_[i]).string(), pose.str()});
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
  std::vector<std::uint64_t> counts = rows_read_;
  for (const FilterCount& filter : kFilterCounts) counts.push_back(filtered_out_.*filter.count);
  counts.push_back(filtered_out_.synthetic);
  return counts;
}

void FileScan::set_pass_counts(std::span<const std::uint64_t> counts) {
  if (counts.size() != rows_read_.size() + std::size(kFilterCounts) + 1)
    fail_inconsistent("the workspace counts another number of files");
  std::copy_n(counts.begin(), rows_read_.size(), rows_read_.begin());
  auto left_out = counts.begin() + static_cast<std::ptrdiff_t>(rows_read_.size());
  for (const FilterCount& filter : kFilterCounts) filtered_out_.*filter.count = *left_out++;
  filtered_out_.synthetic = *left_out;
}

bool FileScan::single_precision() const {
  return std::all_of(layouts_.begin(), layouts_.end(), [](const RowLayout& layout) {
    return std::all_of(kPositionNames.begin(), kPositionNames.end(),
                       [&](const char* name) { return layout.find(name)->type == Scalar::kFloat32; });
  });
}

std::optional<std::size_t> FileScan::find(const std::filesystem::path& file) const {
  const std::optional<FileIdentity> identity = find_identity(file);
  const auto first = identity ? first_of_.find(*identity) : first_of_.end();
  return first == first_of_.end() ? std::nullopt : std::optional(first->second);
}

std::vector<std::size_t> FileScan::repeated() const {
  std::vector<std::size_t> repeated;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const auto first = first_of_.find({states_[i].device, states_[i].inode});
    if (first != first_of_.end() && first->second < i) repeated.push_back(i);
  }
  return repeated;
}

void check_not_input(const ResultFolder& folder, const FileScan& scan) {
  for (const std::filesystem::path& file : folder.earlier_files()) {
    if (const std::optional<std::size_t> input = scan.find(file))
      throw Error(scan.files()[*input].string() +
                  ": is an input in the place of a result; another output folder is needed");
  }
}

}  // namespace lacuna::io
