// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/scan_pass.hpp"

#include "engine/run/error.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/scan/scan_files.hpp"

#include <algorithm>
#include <limits>

#include <spdlog/fmt/fmt.h>

namespace lacuna::io {
namespace {

// Calls visit(count) for each count of `ScanPass::pass_counts`, in order.
template <class Counts, class Visit>
void for_each_count(Counts& counts, const Visit& visit) {
  for (auto& file : counts.files) {
    for (auto* count : {&file.rows, &file.nearer_to_zero, &file.nearer_to_scanner}) visit(*count);
    for (const auto finding : kRowFindings) visit(file.findings.*finding);
  }
  for (const FilterCount& filter : kFilterCounts) visit(counts.filtered_out.*filter.count);
  visit(counts.filtered_out.synthetic);
}

ScanCounts no_counts(const ScanFiles& scan) {
  return {.files = std::vector<FileCounts>(scan.files().size())};
}

std::string describe_no_point(const ScanFiles& scan, const ScanCounts& counts) {
  std::uint64_t rows = 0;
  for (const FileCounts& file : counts.files) rows += file.rows;
  const std::string name =
      scan.files()[0].name.string() + (scan.files().size() > 1 ? " and the other files" : "");
  if (rows == 0) return name + ": no points: a header alone, or empty scans";
  return name + ": no points: none of " + std::to_string(rows) +
         " rows has a place; they are NaN, or rays that are marked as invalid or have no return";
}

}  // namespace

std::vector<std::uint64_t> rows_of(const ScanFiles& scan, const ScanCounts& counts) {
  std::vector<std::uint64_t> rows;
  for (std::size_t i = 0; i < scan.files().size(); ++i)
    rows.push_back(scan.files()[i].expected_rows.value_or(counts.files[i].rows));
  return rows;
}

ScanPass::ScanPass(const ScanFiles& scan, RowObserver* observer)
    : scan_(scan), observer_(observer), counts_{no_counts(scan)}, files_{0, scan.files().size()} {}

SourceParts ScanPass::parts() const {
  return {.points = estimated_rows(scan_), .identity = identity_of(scan_), .names = kept_names(scan_)};
}

void ScanPass::rewind_to(const IndexRange& files, PointId first) {
  files_ = files;
  file_ = files.first;
  next_id_ = value(first);
  reader_.reset();
  counts_ = no_counts(scan_);
  has_point_ = false;
  if (observer_) observer_->begin();
}

std::vector<std::uint64_t> ScanPass::pass_counts() const {
  std::vector<std::uint64_t> counts;
  for_each_count(counts_, [&](std::uint64_t count) { counts.push_back(count); });
  return counts;
}

void ScanPass::set_pass_counts(std::span<const std::uint64_t> counts) {
  if (counts.size() != pass_counts().size())
    fail_inconsistent("the workspace counts another number of files");
  auto next = counts.begin();
  for_each_count(counts_, [&](std::uint64_t& count) { count = *next++; });
}

void ScanPass::refuse_empty() const {
  if (counts_.filtered_out.total() > 0)
    throw Error(describe_no_row_left(scan_.config(), counts_.filtered_out));
  if (!scan_.files().empty() && !scan_.files()[0].arrays) throw Error(describe_no_point(scan_, counts_));
}

void ScanPass::open_file() {
  reader_ = scan_.open(file_);
  filter_.emplace(scan_.config(), scan_.files()[file_].name, *reader_);
}

void ScanPass::count_nearer(std::span<const Eigen::Vector3d> positions) {
  const std::optional<Eigen::Vector3d>& scanner = scan_.files()[file_].scanner;
  if (!scanner) return;
  FileCounts& counts = counts_.files[file_];
  for (const Eigen::Vector3d& position : positions) {
    const double from_zero = position.squaredNorm(), from_scanner = (position - *scanner).squaredNorm();
    counts.nearer_to_zero += from_zero < from_scanner ? 1 : 0;
    counts.nearer_to_scanner += from_zero > from_scanner ? 1 : 0;
  }
}

// The engine does so too, but knows no files.
void ScanPass::refuse_too_far(const PointBatch& batch) const {
  const auto found = std::find_if(batch.positions.begin(), batch.positions.end(), is_too_far);
  if (found == batch.positions.end()) return;
  const std::uint64_t row =
      counts_.files[file_].rows + static_cast<std::uint64_t>(found - batch.positions.begin());
  throw Error(fmt::format("{}: point {} lies at {:g} {:g} {:g}; coordinates must be within 1e30",
                          scan_.files()[file_].name.string(), row, found->x(), found->y(), found->z()));
}

// Makes points of the rows at hand.
void ScanPass::take_rows(PointBatch& batch) {
  const RowLayout& layout = reader_->layout();
  load_vectors(rows_, layout, kPositionNames, batch.positions);
  count_nearer(batch.positions);
  if (observer_) read_ = batch.positions;
  filter_->apply(rows_, batch.positions, counts_.filtered_out);
  if (observer_) observer_->take(file_, *reader_, rows_, read_, batch.positions);
  if (has_vectors(layout, kNormalNames)) {
    load_vectors(rows_, layout, kNormalNames, batch.normals);
  } else if (has_normals()) {
    batch.normals.assign(rows_.count, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  refuse_too_far(batch);
  has_point_ =
      has_point_ || std::ranges::any_of(batch.positions, [](const auto& p) { return p.allFinite(); });
  counts_.files[file_].rows += rows_.count;
  next_id_ += rows_.count;
}

bool ScanPass::next(PointBatch& batch) {
  batch.first = PointId{next_id_};
  batch.positions.clear();
  batch.normals.clear();
  for (; file_ < files_.last; ++file_, reader_.reset()) {
    if (!reader_) open_file();
    if (reader_->next(rows_, scan_.batch_rows(file_))) {
      take_rows(batch);
      return true;
    }
    counts_.files[file_].findings = reader_->findings();
  }
  if (!observer_ || files_.last - files_.first < scan_.files().size()) return false;
  if (!has_point_) refuse_empty();
  observer_->end();
  return false;
}

ScanCounts read_all(const ScanFiles& scan, RowObserver& observer) {
  ScanPass pass(scan, &observer);
  pass.rewind();
  for (PointBatch batch; pass.next(batch);) {
  }
  return pass.counts();
}

}  // namespace lacuna::io
