// SPDX-License-Identifier: Apache-2.0
#include "io/read/rows/pose.hpp"

#include "engine/run/error.hpp"
#include "io/read/files/number.hpp"
#include "io/read/rows/columns.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

constexpr double kTolerance = 1e-3;
constexpr std::size_t kLargestPoseFile = 1 << 16;

std::vector<double> parse_numbers(std::string_view text) {
  constexpr std::string_view kBetween = ", \t\r\n";
  std::vector<double> numbers;
  for (std::size_t at = text.find_first_not_of(kBetween); at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
    const std::string_view word = text.substr(at, end - at);
    if (!parse_number(word, numbers.emplace_back()) || !std::isfinite(numbers.back()))
      throw Error(in_quotes(word) + " is no number of a pose");
    at = text.find_first_not_of(kBetween, end);
  }
  return numbers;
}

Pose from_quaternion(const std::vector<double>& numbers) {
  const Eigen::Quaterniond turn(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (std::abs(turn.norm() - 1) > kTolerance)
    throw Error("the quaternion of a pose has length " + std::to_string(turn.norm()) +
                "; allowed: translation x y z, then a unit quaternion x y z w");
  Pose pose(turn.normalized());
  pose.pretranslate(Eigen::Vector3d(numbers[0], numbers[1], numbers[2]));
  return pose;
}

// Reads the matrix from its first rows, or from all of them.
Eigen::Matrix4d matrix_of(const std::vector<double>& numbers) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < numbers.size(); ++i)
    matrix(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = numbers[i];
  return matrix;
}

}  // namespace

Pose pose_of(const Eigen::Matrix4d& matrix) {
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw Error("the last row of a pose is not 0 0 0 1; the matrix may be transposed");
  const Pose pose(matrix);
  const Eigen::Matrix3d square = pose.linear().transpose() * pose.linear();
  const double scale = square.trace() / 3;
  const bool is_even = (square - scale * Eigen::Matrix3d::Identity()).norm() <= kTolerance * scale;
  if (!is_even || !(pose.linear().determinant() > 0))
    throw Error("the matrix of a pose does not turn the scan; it shears, mirrors or flattens it");
  return pose;
}

Pose parse_pose(std::string_view text) {
  const std::vector<double> numbers = parse_numbers(text);
  if (numbers.size() != 7 && numbers.size() != 12 && numbers.size() != 16)
    throw Error(
        "a pose of " + std::to_string(numbers.size()) +
        " numbers; allowed: 16 (a 4 x 4 matrix), 12 (its first rows), or 7 (x y z, quaternion x y z w)");
  if (numbers.size() == 7) return from_quaternion(numbers);
  return pose_of(matrix_of(numbers));
}

Pose read_pose(const std::filesystem::path& file) {
  InputFile in(file);
  if (in.remaining() > kLargestPoseFile) in.fail("too large for a pose of 16 numbers");
  std::string text(in.remaining(), '\0');
  in.read(reinterpret_cast<std::byte*>(text.data()), text.size());
  try {
    return parse_pose(text);
  } catch (const Error& error) {
    in.fail(error.what());
  }
}

std::optional<double> component_of(const LocalOffset& offset, std::string_view column) {
  const auto axis = std::find(kPositionNames.begin(), kPositionNames.end(), column);
  if (!offset || axis == kPositionNames.end()) return std::nullopt;
  return (*offset)[axis - kPositionNames.begin()];
}

std::string print_offset(const Eigen::Vector3d& offset) {
  std::string text = "lacuna offset";
  for (const double number : offset) {
    std::array<char, 400> digits;  // as many as a double may have before its point, and more
    const auto [end, status] = std::to_chars(digits.begin(), digits.end(), number, std::chars_format::fixed);
    text.append(" ").append(digits.begin(), end);
  }
  return text;
}

void read_offset(const InputFile& in, std::span<const std::string_view> comment, LocalOffset& offset) {
  if (comment.size() < 2 || comment[0] != "lacuna" || comment[1] != "offset") return;
  if (offset) in.fail_at_line(in.line(), "a second 'lacuna offset'; one is allowed");
  Eigen::Vector3d numbers;
  bool is_known = comment.size() == kOffsetWords;
  for (std::size_t i = 2; is_known && i < kOffsetWords; ++i) {
    double& number = numbers[static_cast<Eigen::Index>(i - 2)];
    is_known = parse_number(comment[i], number) && std::isfinite(number);
  }
  if (!is_known) in.fail_at_line(in.line(), "'lacuna offset X Y Z' with three numbers expected");
  offset = numbers;
}

namespace {

// The rows of another reader, with some of its columns as doubles, which `move` changes.
class MovedReader : public ScanReader {
 public:
  MovedReader(std::unique_ptr<ScanReader> reader, RowLayout layout)
      : reader_(std::move(reader)), layout_(std::move(layout)) {}

  std::string format() const final { return reader_->format(); }
  const RowLayout& layout() const final { return layout_; }
  std::optional<std::uint64_t> expected_rows() const final { return reader_->expected_rows(); }
  bool is_slow() const final { return reader_->is_slow(); }
  std::vector<ScannerPose> scanners() const override { return reader_->scanners(); }
  std::vector<Eigen::Vector3d> no_return_places() const override { return reader_->no_return_places(); }
  bool has_scanner_at_zero() const final { return reader_->has_scanner_at_zero(); }
  bool has_noise_classes() const final { return reader_->has_noise_classes(); }
  std::vector<ReaderNote> notes() const final { return reader_->notes(); }
  RowFindings findings() const final { return reader_->findings(); }

  bool next(RowBatch& batch, std::size_t max_rows) final {
    if (!reader_->next(rows_, max_rows)) return false;
    batch.count = rows_.count;
    batch.bytes.resize(rows_.count * layout_.stride);
    for (std::size_t i = 0; i < layout_.properties.size(); ++i) {
      const RowLayout& from = reader_->layout();
      copy_column(column_of(std::as_const(rows_), from.stride, from.properties[i]),
                  column_of(batch, layout_.stride, layout_.properties[i]), rows_.count);
    }
    move(batch);
    return true;
  }

 protected:
  virtual void move(RowBatch& batch) = 0;

  // Changes three columns of doubles, row by row.
  template <class Change>
  void change(RowBatch& batch, const VectorNames& names, const Change& change) {
    load_vectors(batch, layout_, names, vectors_);
    for (Eigen::Vector3d& vector : vectors_) vector = change(vector);
    store_vectors(vectors_, layout_, names, batch);
  }

  const ScanReader& reader() const { return *reader_; }

 private:
  std::unique_ptr<ScanReader> reader_;
  RowLayout layout_;
  RowBatch rows_;  // as the reader gives them
  std::vector<Eigen::Vector3d> vectors_;
};

RowLayout with_doubles(const RowLayout& layout) {
  return with_components_as(Scalar::kFloat64, kPositionNames, layout);
}

class OffsetReader final : public MovedReader {
 public:
  OffsetReader(std::unique_ptr<ScanReader> reader, RowLayout layout, const Eigen::Vector3d& offset)
      : MovedReader(std::move(reader), std::move(layout)), offset_(offset) {}

 private:
  void move(RowBatch& batch) override {
    change(batch, kPositionNames, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p + offset_; });
  }

  Eigen::Vector3d offset_;
};

// `pose` moves positions, and `turn` normals. `is_of_scanner`: the scan begins at its scanner's place.
class PosedReader final : public MovedReader {
 public:
  PosedReader(std::unique_ptr<ScanReader> reader, RowLayout layout, const Pose& pose,
              const Eigen::Matrix3d& turn, bool is_of_scanner)
      : MovedReader(std::move(reader), std::move(layout)),
        pose_(pose),
        turn_(turn),
        is_of_scanner_(is_of_scanner) {}

  std::string length_unit() const override {
    const bool is_rigid = std::abs(pose_.linear().determinant() - 1) < 1e-6;
    return is_rigid ? reader().length_unit() : "";
  }
  std::vector<Eigen::Vector3d> no_return_places() const override {
    std::vector<Eigen::Vector3d> places = reader().no_return_places();
    for (Eigen::Vector3d& place : places) place = pose_ * place;
    return places;
  }

  // A scan that is moved to its place, and names no scanner, begins at its own. So does a scan that is moved
  // to the viewpoint of its file.
  std::vector<ScannerPose> scanners() const override {
    std::vector<ScannerPose> scanners = reader().scanners();
    const std::optional<Pose> viewpoint = reader().viewpoint();
    if (is_of_scanner_ && viewpoint && viewpoint->isApprox(pose_)) scanners.clear();
    if (scanners.empty() && is_of_scanner_) scanners.push_back({.place = Eigen::Vector3d::Zero()});
    for (ScannerPose& scanner : scanners) {
      scanner.place = pose_ * scanner.place;
      scanner.axis = (pose_.linear() * scanner.axis).normalized();
    }
    return scanners;
  }

 private:
  void move(RowBatch& batch) override {
    change(batch, kPositionNames, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return pose_ * p; });
    if (!has_vectors(layout(), kNormalNames)) return;
    change(batch, kNormalNames, [&](const Eigen::Vector3d& n) -> Eigen::Vector3d { return turn_ * n; });
  }

  Pose pose_;
  Eigen::Matrix3d turn_;
  bool is_of_scanner_;
};

}  // namespace

std::unique_ptr<ScanReader> with_offset(std::unique_ptr<ScanReader> reader, const LocalOffset& offset) {
  if (!offset) return reader;
  RowLayout layout = with_doubles(reader->layout());
  return std::make_unique<OffsetReader>(std::move(reader), std::move(layout), *offset);
}

std::unique_ptr<ScanReader> posed(std::unique_ptr<ScanReader> reader, const Pose& pose) {
  RowLayout layout = with_components_as(Scalar::kFloat64, kNormalNames, with_doubles(reader->layout()));
  const Eigen::Matrix3d turn = pose.linear() / std::cbrt(pose.linear().determinant());
  return std::make_unique<PosedReader>(std::move(reader), std::move(layout), pose, turn, true);
}

std::unique_ptr<ScanReader> with_z_times(std::unique_ptr<ScanReader> reader, double factor) {
  RowLayout layout = with_components_as(Scalar::kFloat64, kNormalNames, with_doubles(reader->layout()));
  Pose pose = Pose::Identity();
  pose.linear()(2, 2) = factor;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn(2, 2) = 1 / factor;
  return std::make_unique<PosedReader>(std::move(reader), std::move(layout), pose, turn, false);
}

}  // namespace lacuna::io
