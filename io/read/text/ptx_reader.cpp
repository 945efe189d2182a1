// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/readers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace lacuna::io {
namespace {

using Values = std::array<double, 8>;

// Reads numbers of a line divided by blanks; none if one is not a number or there are too many.
std::optional<std::size_t> parse_line(std::string_view line, Values& values) {
  std::size_t count = 0;
  for (std::string_view field; next_field(line, ' ', field); ++count) {
    if (count == values.size() || !parse_number(field, values[count])) return std::nullopt;
  }
  return count;
}

bool is_count(std::string_view line) {
  std::string_view field, rest = line;
  std::uint64_t count = 0;
  return next_field(rest, ' ', field) && parse_number(field, count) && !next_field(rest, ' ', field);
}

class PtxReader final : public ScanReader {
 public:
  explicit PtxReader(const std::filesystem::path& file) : in_(file) {
    // The first ray says whether there are colours. Scans before it may be empty.
    while (begin_block() && left_ == 0) {
    }
    std::vector<std::pair<std::string, Scalar>> columns = {{"x", Scalar::kFloat64},
                                                           {"y", Scalar::kFloat64},
                                                           {"z", Scalar::kFloat64},
                                                           {"intensity", Scalar::kFloat32}};
    if (left_ > 0) {
      has_colours_ = read_ray() == 7;
      is_pending_ = true;
    }
    if (has_colours_) {
      for (const char* colour : {"red", "green", "blue"}) columns.emplace_back(colour, Scalar::kUint8);
    }
    columns.emplace_back("scan", Scalar::kUint32);
    layout_ = packed_layout(columns);
  }

  std::string format() const override { return "PTX"; }
  const RowLayout& layout() const override { return layout_; }
  std::optional<std::uint64_t> expected_rows() const override {
    return std::nullopt;
  }  // more blocks may follow

  std::vector<ScannerPose> scanners() const override { return scanners_; }
  RowFindings findings() const override { return findings_; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    return fill_batch(batch, max_rows, layout_.stride, [&](std::byte* to) {
      while (left_ == 0) {  // after a block, which may be an empty grid
        if (!begin_block()) return false;
      }
      if (!is_pending_) read_ray();
      is_pending_ = false;
      put_ray(to);
      if (--left_ == 0) end_block();
      return true;
    });
  }

 private:
  // Passes the ten lines before the rays; false at the end of the file.
  bool begin_block() {
    const std::optional<std::string_view> first = next_full_line();
    if (!first) return false;
    const std::uint64_t columns = read_count(*first);
    const std::uint64_t rows = read_count(next_line());
    if (rows > 0 && columns > std::numeric_limits<std::uint64_t>::max() / rows)
      in_.fail_at_line(in_.line(),
                       "a grid of " + std::to_string(columns) + " x " + std::to_string(rows) + " rays");
    left_ = columns * rows;
    read_values(3);
    const Eigen::Vector3d place = Eigen::Vector3d::Map(line_.data());
    for (int i = 0; i < 3; ++i) read_values(3);  // the scanner's axes, which the matrix has too
    read_matrix();
    block_ = {.off = (place - pose_.translation()).norm()};
    scanners_.push_back(
        {.place = pose_.translation(), .axis = pose_.linear().col(2).normalized(), .source = scan_});
    ++scan_;
    return true;
  }

  // The matrix is of row vectors. Nothing depends on it in an empty grid.
  void read_matrix() {
    Eigen::Matrix4d matrix;
    for (const Eigen::Index column : {0, 1, 2, 3}) {
      read_values(4);
      matrix.col(column) = Eigen::Vector4d::Map(line_.data());
    }
    try {
      pose_ = left_ > 0 ? pose_of(matrix) : Pose(matrix);
    } catch (const Error& error) {
      in_.fail_at_line(in_.line(), std::string("of the matrix by columns, ") + error.what());
    }
  }

  void end_block() {
    if (block_.shorter > block_.steps / 2) ++findings_.other_places;
  }

  // Reads the next line that is not blank.
  std::optional<std::string_view> next_full_line() {
    while (const auto line = in_.next_line()) {
      if (line->find_first_not_of(" \t\r") != line->npos) return line;
    }
    return std::nullopt;
  }

  std::string_view next_line() {
    const std::optional<std::string_view> line = next_full_line();
    if (!line) in_.fail_at_line(in_.line() + 1, "the file ends here, too early");
    return *line;
  }

  std::uint64_t read_count(std::string_view line) {
    std::string_view field;
    std::uint64_t count = 0;
    if (!is_count(line) || !next_field(line, ' ', field) || !parse_number(field, count))
      in_.fail_at_line(in_.line(), in_quotes(line) + " is no number of rows or columns");
    return count;
  }

  void read_values(std::size_t count) {
    if (parse_line(next_line(), line_) != count)
      in_.fail_at_line(in_.line(), "a pose needs " + std::to_string(count) + " numbers here");
  }

  // Returns the number of its values, 4 or 7.
  std::size_t read_ray() {
    const std::optional<std::size_t> count = parse_line(next_line(), line_);
    if (count != 4 && count != 7)
      in_.fail_at_line(in_.line(), "a ray needs x y z intensity, or x y z intensity red green blue");
    std::fill(line_.begin() + static_cast<std::ptrdiff_t>(*count), line_.end(), 0.0);
    return *count;
  }

  void put_ray(std::byte* to) {
    const Eigen::Vector3d own = Eigen::Vector3d::Map(line_.data());
    const bool is_return = !own.isZero(0);
    if (is_return && own.allFinite()) block_.take(own);
    const Eigen::Vector3d place =
        is_return ? pose_ * own : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    for (const double coordinate : place) store_next(to, coordinate);
    store_next(to, static_cast<float>(line_[3]));
    // Scans with and without colours may follow each other: without is black.
    for (std::size_t i = 4; has_colours_ && i < 7; ++i) {
      if (std::isnan(line_[i]))
        in_.fail_at_line(in_.line(), "a colour is not a number; 0 to 255 are allowed");
      store_next(to, static_cast<std::uint8_t>(std::clamp(line_[i], 0.0, 255.0)));
    }
    store_next(to, scan_ - 1);
  }

  // What the returns of a block say of its pose.
  struct Block {
    double off;  // from the place that the block states to the place of its matrix
    std::optional<Eigen::Vector3d> last{};
    std::uint64_t steps = 0, shorter = 0;  // from return to return; those that are shorter than `off`

    void take(const Eigen::Vector3d& point) {
      if (last) {
        ++steps;
        shorter += (point - *last).norm() < off ? 1 : 0;
      }
      last = point;
    }
  };

  InputFile in_;
  RowLayout layout_;
  Pose pose_;
  Block block_{.off = 0};
  RowFindings findings_;
  std::uint64_t left_ = 0;             // rays of the block not yet read
  std::uint32_t scan_ = 0;             // blocks begun
  std::vector<ScannerPose> scanners_;  // of the blocks begun
  bool has_colours_ = false;           // the first ray has
  Values line_{};                      // the last one read
  bool is_pending_ = false;            // it is a ray that is not yet in a batch
};

}  // namespace

bool looks_like_ptx(const FileStart& start) {
  std::string_view first_bytes = start.first_bytes;
  std::array<std::string_view, 3> lines;
  for (std::string_view& line : lines) {
    const std::size_t end = first_bytes.find('\n');
    if (end == first_bytes.npos) return false;
    line = first_bytes.substr(0, end);
    first_bytes.remove_prefix(end + 1);
  }
  Values values;
  return is_count(lines[0]) && is_count(lines[1]) && parse_line(lines[2], values) == std::size_t{3};
}

std::unique_ptr<ScanReader> open_ptx(const std::filesystem::path& file, const ReadOptions&) {
  return std::make_unique<PtxReader>(file);
}

}  // namespace lacuna::io
