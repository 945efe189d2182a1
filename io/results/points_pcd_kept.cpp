// SPDX-License-Identifier: Apache-2.0
#include "io/pcd/pcd_fields.hpp"
#include "io/pcd/pcd_rows.hpp"
#include "io/property_name.hpp"
#include "io/results/points_pcd_rows.hpp"
#include "io/scalar.hpp"
#include "io/vectors.hpp"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

// A part of each row of the input that stays as it is.
struct Part {
  std::size_t from, to, bytes;
};

// A coordinate that another offset holds for.
struct Coordinate {
  PcdField field;  // as the input has it
  std::size_t from, to;
  Scalar type;  // as it is written
  Eigen::Index axis;
};

// What stays of PCD rows.
struct Kept {
  PcdHeader header;  // of one of the files; its fields are those that stay
  std::vector<Part> parts;
  std::vector<Coordinate> coordinates;
};

bool has_same_fields(const PcdHeader& a, const PcdHeader& b) {
  return std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), b.fields.end(),
                    [](const PcdField& f, const PcdField& g) {
                      return f.name == g.name && f.type == g.type && f.size == g.size && f.count == g.count;
                    });
}

// The header of the joined rows, with all fields. None unless all files are PCD with the same fields and stay
// where they are. `is_local` becomes true where a file has local coordinates.
std::optional<PcdHeader> common_header(const FileScan& scan, bool& is_local) {
  std::optional<PcdHeader> common;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    if (scan.poses()[i] || !scan.formats()[i].starts_with("PCD")) return std::nullopt;
    InputFile in(scan.files()[i]);
    PcdHeader header = read_pcd_header(in);
    is_local = is_local || header.offset;
    if (!common) {
      common = std::move(header);
      continue;
    }
    if (!has_same_fields(*common, header)) return std::nullopt;
    common->rows = common->width = common->rows + header.rows;  // no image any more, and no place of one
    common->height = 1;                                         // scanner
    common->viewpoint = PcdHeader{}.viewpoint;
  }
  return common;
}

// The place of the scanner, as far as it is known, relative to another offset. It is rounded as points are.
void move_viewpoint(const LocalOffset& offset, PcdHeader& header) {
  if (const auto scanner = header.scanner()) {
    auto place = Eigen::Vector3d::Map(header.viewpoint.data());
    if (offset) {
      place = (*scanner - *offset).unaryExpr([](double value) { return double(nearest_float(value)); });
    } else {
      place = *scanner;
    }
  }
  header.offset = offset;
}

Kept kept_fields(PcdHeader header, std::span<const ResultColumn> results, bool is_moved,
                 const LocalOffset& offset) {
  const std::vector<PcdField> fields = std::exchange(header.fields, {});
  move_viewpoint(offset, header);
  Kept kept{.header = std::move(header), .parts = {}, .coordinates = {}};
  std::size_t from = 0, to = 0;
  for (const PcdField& field : fields) {
    const auto is_same = [&](const ResultColumn& result) { return pcd_name_of(result.name) == field.name; };
    if (!field.is_padding() && std::none_of(results.begin(), results.end(), is_same)) {
      const auto axis = std::find(kPositionNames.begin(), kPositionNames.end(), known_name(field.name));
      PcdField written = field;
      if (is_moved && axis != kPositionNames.end()) {
        const Scalar type = offset ? Scalar::kFloat32 : Scalar::kFloat64;
        written = pcd_field_of(field.name, type);
        kept.coordinates.push_back(
            {.field = field, .from = from, .to = to, .type = type, .axis = axis - kPositionNames.begin()});
      } else if (!kept.parts.empty() && kept.parts.back().from + kept.parts.back().bytes == from &&
                 kept.parts.back().to + kept.parts.back().bytes == to) {
        kept.parts.back().bytes += field.bytes();
      } else {
        kept.parts.push_back({from, to, field.bytes()});
      }
      to += written.bytes();
      kept.header.fields.push_back(std::move(written));
    }
    from += field.bytes();
  }
  return kept;
}

// Rows of PCD files without the fields that do not stay.
class KeptRows final : public InputRows {
 public:
  KeptRows(const FileScan& scan, Kept kept) : scan_(scan), kept_(std::move(kept)) {}

  std::size_t next(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) override {
    for (; file_ < scan_.files().size(); ++file_, rows_.reset()) {
      if (!rows_) rows_.emplace(scan_.files()[file_]);
      const std::size_t count = rows_->next(raw_, max_rows);
      if (count == 0) continue;
      block.resize(count * stride);
      const std::size_t raw_stride = raw_.size() / count;
      for (std::size_t row = 0; row < count; ++row) {
        for (const Part& part : kept_.parts)
          std::memcpy(&block[row * stride + part.to], &raw_[row * raw_stride + part.from], part.bytes);
      }
      for (const Coordinate& coordinate : kept_.coordinates) copy(coordinate, count, stride, block);
      return count;
    }
    return 0;
  }

  void positions(std::vector<Eigen::Vector3d>& positions) const override {
    const PcdHeader& header = rows_->header();
    const std::size_t stride = header.row_bytes();
    positions.resize(raw_.size() / stride);
    std::size_t at = 0;
    for (const PcdField& field : header.fields) {
      const auto axis = std::find(kPositionNames.begin(), kPositionNames.end(), known_name(field.name));
      if (!field.is_padding() && axis != kPositionNames.end()) {
        const Eigen::Index component = axis - kPositionNames.begin();
        const double added = header.offset ? (*header.offset)[component] : 0.0;
        with_pcd_type(field, [&](auto value) {
          for (std::size_t row = 0; row < positions.size(); ++row) {
            std::memcpy(&value, &raw_[row * stride + at], sizeof(value));
            positions[row][component] = static_cast<double>(value) + added;
          }
        });
      }
      at += field.bytes();
    }
  }

 private:
  void copy(const Coordinate& coordinate, std::size_t count, std::size_t stride,
            std::vector<std::byte>& block) const {
    const auto along = [&](const LocalOffset& offset) { return offset ? (*offset)[coordinate.axis] : 0.0; };
    const double own = along(rows_->header().offset), other = along(kept_.header.offset);
    const std::size_t raw_stride = raw_.size() / count;
    with_pcd_type(coordinate.field, [&](auto value) {
      for (std::size_t row = 0; row < count; ++row) {
        std::memcpy(&value, &raw_[row * raw_stride + coordinate.from], sizeof(value));
        put_floating(&block[row * stride + coordinate.to], coordinate.type,
                     static_cast<double>(value) + own - other);
      }
    });
  }

  const FileScan& scan_;
  Kept kept_;
  std::size_t file_ = 0;
  std::optional<PcdRows> rows_;
  std::vector<std::byte> raw_;
};

}  // namespace

std::optional<PcdInput> kept_pcd_input(const FileScan& scan, std::span<const ResultColumn> results,
                                       const LocalOffset& offset) {
  bool is_local = false;
  std::optional<PcdHeader> header = common_header(scan, is_local);
  if (!header) return std::nullopt;
  Kept kept = kept_fields(std::move(*header), results, is_local || offset, offset);
  PcdHeader written = kept.header;
  return PcdInput{std::move(written), std::make_unique<KeptRows>(scan, std::move(kept))};
}

}  // namespace lacuna::io
