#include "io/file_scan.hpp"

#include "io/scalar.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace lacuna {
namespace {

constexpr std::size_t kBatchRows = std::size_t{1} << 16;

using Names = std::array<const char*, 3>;
constexpr Names kPosition = {"x", "y", "z"};
constexpr Names kNormal = {"nx", "ny", "nz"};

bool has_all(const RowLayout& layout, const Names& names) {
  return std::all_of(names.begin(), names.end(), [&](const char* name) { return layout.find(name); });
}

void copy_vectors(const RowBatch& rows, const RowLayout& layout, const Names& names,
                  std::vector<Eigen::Vector3d>& vectors) {
  vectors.resize(rows.count);
  if (rows.count == 0) return;
  auto* to = reinterpret_cast<std::byte*>(vectors.data());
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    const Property& property = *layout.find(names[axis]);
    copy_column(
        {.data = rows.bytes.data() + property.offset, .stride = layout.stride, .type = property.type},
        {.data = to + axis * sizeof(double), .stride = sizeof(Eigen::Vector3d), .type = Scalar::kFloat64},
        rows.count);
  }
}

}  // namespace

FileScan::FileScan(std::vector<std::filesystem::path> files, ReadOptions options)
    : files_(std::move(files)), options_(std::move(options)), expected_points_(0) {
  for (const auto& file : files_) {
    states_.push_back(file_state(file));
    const auto reader = open_scan(file, options_);
    layouts_.push_back(reader->layout());
    has_normals_ = has_normals_ || has_all(layouts_.back(), kNormal);
    expected_rows_.push_back(reader->expected_rows());
    if (expected_points_ && expected_rows_.back()) {
      *expected_points_ += *expected_rows_.back();
    } else {
      expected_points_.reset();
    }
  }
}

std::unique_ptr<ScanReader> FileScan::open(std::size_t file) const {
  lacuna::check_unchanged(files_[file], states_[file]);
  return open_scan(files_[file], options_);
}

void FileScan::check_unchanged() const {
  for (std::size_t i = 0; i < files_.size(); ++i) lacuna::check_unchanged(files_[i], states_[i]);
}

void FileScan::rewind() {
  file_ = 0;
  next_id_ = 0;
  reader_.reset();
}

bool FileScan::next(PointBatch& batch) {
  batch.first = PointId{next_id_};
  batch.positions.clear();
  batch.normals.clear();
  for (; file_ < files_.size(); ++file_, reader_.reset()) {
    if (!reader_) reader_ = open(file_);
    if (!reader_->next(rows_, kBatchRows)) continue;
    const RowLayout& layout = reader_->layout();
    copy_vectors(rows_, layout, kPosition, batch.positions);
    if (has_all(layout, kNormal)) {
      copy_vectors(rows_, layout, kNormal, batch.normals);
    } else if (has_normals_) {
      batch.normals.assign(rows_.count, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
    next_id_ += rows_.count;
    return true;
  }
  return false;
}

std::optional<std::uint64_t> FileScan::expected_points() const {
  return expected_points_;
}

bool FileScan::has_normals() const {
  return has_normals_;
}

bool FileScan::single_precision() const {
  return std::all_of(layouts_.begin(), layouts_.end(), [](const RowLayout& layout) {
    return std::all_of(kPosition.begin(), kPosition.end(),
                       [&](const char* name) { return layout.find(name)->type == Scalar::kFloat32; });
  });
}

}  // namespace lacuna
