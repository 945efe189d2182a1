// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/scan_files.hpp"

#include "io/read/rows/columns.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/scan/like_degrees.hpp"
#include "io/read/scan/row_filter.hpp"
#include "io/read/scan/scan_systems.hpp"

#include <algorithm>

namespace lacuna::io {

ReadOptions read_options(const InputConfig& config, std::uint64_t memory) {
  return {.columns = config.columns,
          .memory = memory,
          .trust = config.trust,
          .skip_damaged = config.skip_damaged};
}

ScanFiles::ScanFiles(std::vector<ScanInput> inputs, InputConfig config, std::uint64_t memory)
    : config_(std::move(config)), memory_(memory), stated_(read_stated_crs(config_)) {
  for (ScanInput& input : inputs) add_file(std::move(input));
  common_ = choose_systems(config_, stated_, files_);
  const auto is_text = [](const ScanFile& file) { return file.format == Format::kText; };
  if (!config_.columns.empty() && std::ranges::none_of(files_, is_text))
    throw UsageError("--columns: names columns of text, and no file of the scan is text");
}

void ScanFiles::add_file(ScanInput input) {
  ScanFile& file = files_.emplace_back(ScanFile{std::move(input)});
  if (!file.arrays) {
    file.state = file_state(file.name);
    file.format = format_of(file.name);
  }
  const auto reader = open_in_own_units(files_.size() - 1);
  const RowFilter filter(config_, file.name, *reader);
  file.layout = reader->layout();
  file.crs = reader->crs();
  file.other_crs = reader->other_crs();
  file.unit = reader->length_unit();
  file.other_unit = reader->other_unit();
  file.z_unit = reader->vertical_unit();
  file.notes = reader->notes();
  file.has_scanner_at_zero = !file.pose && reader->has_scanner_at_zero();
  const std::vector<ScannerPose> scanners = reader->scanners();
  if (!file.pose && scanners.size() == 1 && !scanners[0].source) file.scanner = scanners[0].place;
  file.expected_rows = reader->expected_rows();
  file.is_geographic = reader->is_geographic();
  const bool says_nothing = file.crs.empty() && file.unit.empty() && file.other_unit.empty();
  file.may_be_degrees = !file.is_geographic && says_nothing && look_like_degrees(*reader);
  reads_slowly_ = reads_slowly_ || reader->is_slow();
  has_normals_ = has_normals_ || has_vectors(file.layout, kNormalNames);
  has_scanners_ = has_scanners_ || !scanners.empty();
}

std::optional<std::uint64_t> ScanFiles::expected_points() const {
  std::uint64_t points = 0;
  for (const ScanFile& file : files_) {
    if (!file.expected_rows) return std::nullopt;
    points += *file.expected_rows;
  }
  return points;
}

std::size_t ScanFiles::batch_rows(std::size_t file) const {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 16;
  return std::clamp<std::uint64_t>(memory_ / 2 / files_[file].layout.stride, 1, kMost);
}

std::unique_ptr<ScanReader> ScanFiles::open(std::size_t file) const {
  auto reader = open_in_own_units(file);
  const double factor = files_[file].z_factor;
  return factor == 1 ? std::move(reader) : with_z_times(std::move(reader), factor);
}

std::unique_ptr<ScanReader> ScanFiles::open_in_own_units(std::size_t index) const {
  const ScanFile& file = files_[index];
  if (file.arrays) return read_arrays(*file.arrays);
  io::check_unchanged(file.name, file.state);
  auto reader = open_scan(*file.format, file.name, read_options(config_, memory_));
  return file.pose ? posed(std::move(reader), *file.pose) : std::move(reader);
}

void ScanFiles::check_unchanged() const {
  for (const ScanFile& file : files_) {
    if (!file.arrays) io::check_unchanged(file.name, file.state);
  }
}

std::vector<RowLayout> layouts_of(const ScanFiles& scan) {
  std::vector<RowLayout> layouts;
  for (const ScanFile& file : scan.files()) layouts.push_back(file.layout);
  return layouts;
}

std::vector<std::filesystem::path> names_of(const ScanFiles& scan) {
  std::vector<std::filesystem::path> names;
  for (const ScanFile& file : scan.files()) names.push_back(file.name);
  return names;
}

std::vector<std::uint64_t> estimated_rows(const ScanFiles& scan) {
  constexpr std::uint64_t kBytesOfLine = 24;
  std::vector<std::uint64_t> rows;
  for (const ScanFile& file : scan.files())
    rows.push_back(file.expected_rows.value_or(file.state.size / kBytesOfLine));
  return rows;
}

bool has_single_precision(const ScanFiles& scan) {
  return std::ranges::all_of(scan.files(), [](const ScanFile& file) {
    return std::ranges::all_of(
        kPositionNames, [&](const char* name) { return file.layout.find(name)->type == Scalar::kFloat32; });
  });
}

}  // namespace lacuna::io
