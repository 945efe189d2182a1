#include "io/pcd/pcd_rows.hpp"
#include "io/results/points_pcd_rows.hpp"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

// A part of each row of the input that stays as it is.
struct Part {
  std::size_t from, bytes;
};

// What stays of PCD rows.
struct Kept {
  PcdHeader header;  // of one of the files; its fields are those that stay
  std::vector<Part> parts;
};

bool has_same_fields(const PcdHeader& a, const PcdHeader& b) {
  return std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), b.fields.end(),
                    [](const PcdField& f, const PcdField& g) {
                      return f.name == g.name && f.type == g.type && f.size == g.size && f.count == g.count;
                    });
}

// None unless all files are PCD with the same fields and stay where they are.
std::optional<Kept> kept_fields(const FileScan& scan, std::span<const ResultColumn> results) {
  std::optional<Kept> kept;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    if (scan.poses()[i] || !scan.formats()[i].starts_with("PCD")) return std::nullopt;
    InputFile in(scan.files()[i]);
    PcdHeader header = read_pcd_header(in);
    if (!kept) {
      kept = {.header = header, .parts = {}};
      continue;
    }
    if (!has_same_fields(kept->header, header)) return std::nullopt;
    const std::uint64_t rows = kept->header.rows + header.rows;
    kept->header.rows = kept->header.width = rows;  // no image any more, and no place of one scanner
    kept->header.height = 1;
    kept->header.viewpoint = PcdHeader{}.viewpoint;
  }
  if (!kept) return std::nullopt;
  std::vector<PcdField> fields;
  std::size_t from = 0;
  for (const PcdField& field : kept->header.fields) {
    const auto is_same = [&](const ResultColumn& result) { return pcd_name_of(result.name) == field.name; };
    if (!field.is_padding() && std::none_of(results.begin(), results.end(), is_same)) {
      fields.push_back(field);
      if (!kept->parts.empty() && kept->parts.back().from + kept->parts.back().bytes == from) {
        kept->parts.back().bytes += field.bytes();
      } else {
        kept->parts.push_back({from, field.bytes()});
      }
    }
    from += field.bytes();
  }
  kept->header.fields = std::move(fields);
  return kept;
}

// Rows of PCD files without the fields that do not stay.
class KeptRows final : public InputRows {
 public:
  KeptRows(const FileScan& scan, std::vector<Part> parts) : scan_(scan), parts_(std::move(parts)) {}

  std::size_t next(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) override {
    for (; file_ < scan_.files().size(); ++file_, rows_.reset()) {
      if (!rows_) rows_.emplace(scan_.files()[file_]);
      const std::size_t count = rows_->next(raw_, max_rows);
      if (count == 0) continue;
      block.resize(count * stride);
      const std::size_t raw_stride = raw_.size() / count;
      for (std::size_t row = 0; row < count; ++row) {
        std::byte* to = &block[row * stride];
        for (const Part& part : parts_) {
          std::memcpy(to, &raw_[row * raw_stride + part.from], part.bytes);
          to += part.bytes;
        }
      }
      return count;
    }
    return 0;
  }

 private:
  const FileScan& scan_;
  std::vector<Part> parts_;
  std::size_t file_ = 0;
  std::optional<PcdRows> rows_;
  std::vector<std::byte> raw_;
};

}  // namespace

std::optional<PcdInput> kept_pcd_input(const FileScan& scan, std::span<const ResultColumn> results) {
  std::optional<Kept> kept = kept_fields(scan, results);
  if (!kept) return std::nullopt;
  return PcdInput{std::move(kept->header), std::make_unique<KeptRows>(scan, std::move(kept->parts))};
}

}  // namespace lacuna::io
