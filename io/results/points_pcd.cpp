#include "engine/run/error.hpp"
#include "io/pcd/pcd_fields.hpp"
#include "io/pcd/pcd_rows.hpp"
#include "io/results/annotated_rows.hpp"
#include "io/results/points.hpp"
#include "io/scalar.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <set>
#include <utility>

namespace lacuna {
namespace {

PcdField field_of(std::string name, Scalar type) {
  const bool is_signed = type == Scalar::kInt8 || type == Scalar::kInt16 || type == Scalar::kInt32;
  return {.name = std::move(name),
          .type = is_integer(type) ? (is_signed ? 'I' : 'U') : 'F',
          .size = size_of(type)};
}

// PCL's names of normals.
std::string pcd_name_of(const std::string& name) {
  if (name == "nx" || name == "ny" || name == "nz") return std::string("normal_") + name[1];
  return name;
}

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

// The columns of any formats, in PCL's conventions.
struct Converted {
  RowLayout layout;  // of the joined rows, colours side by side where they become one field
  std::vector<PcdField> fields;
  std::optional<std::size_t>
      colour;  // offset of red in the layout; then green, blue and, if there is one, alpha
  std::size_t channels = 3;
};

Converted converted_fields(const FileScan& scan, std::span<const ResultColumn> results) {
  const RowLayout joined = join_layouts(scan.layouts(), [&](const RowLayout& layout, std::size_t i) {
    return is_earlier_result(layout, i, results);
  });
  constexpr std::array kChannels = {"red", "green", "blue", "alpha"};
  const auto is_byte = [&](const char* name) {
    const Property* const found = joined.find(name);
    return found != nullptr && found->type == Scalar::kUint8;
  };
  const bool is_packed = std::all_of(kChannels.begin(), kChannels.begin() + 3, is_byte);
  Converted made;
  made.channels = is_packed && is_byte("alpha") ? 4 : 3;
  const auto is_channel = [&](const std::string& name) {
    return is_packed &&
           std::find(kChannels.begin(), kChannels.begin() + static_cast<std::ptrdiff_t>(made.channels),
                     name) != kChannels.begin() + static_cast<std::ptrdiff_t>(made.channels);
  };

  std::set<std::string> names;
  for (const ResultColumn& result : results) names.insert(pcd_name_of(result.name));
  if (is_packed) names.insert({"rgb", "rgba"});
  // Names with a meaning in PCD, and second ones, get a number: a column `rgb` of four bytes would be a
  // colour.
  const auto unique_name = [&](const Property& property) {
    const std::string given = pcd_name_of(property.name);
    const bool is_colour = (given == "rgb" || given == "rgba") && size_of(property.type) == 4;
    std::string name = given;
    for (int i = 2; name == "_" || (is_colour && name == given) || names.contains(name); ++i)
      name = given + '_' + std::to_string(i);
    names.insert(name);
    return name;
  };
  std::vector<std::pair<std::string, Scalar>> columns;
  std::size_t offset = 0;
  for (const Property& property : joined.properties) {
    if (is_channel(property.name)) {
      if (made.colour) continue;
      made.colour = offset;
      for (std::size_t i = 0; i < made.channels; ++i) columns.emplace_back(kChannels[i], Scalar::kUint8);
      offset += made.channels;
      // PCL's own type of each.
      made.fields.push_back(
          {.name = made.channels == 4 ? "rgba" : "rgb", .type = made.channels == 4 ? 'U' : 'F'});
    } else {
      columns.emplace_back(property.name, property.type);
      offset += size_of(property.type);
      made.fields.push_back(field_of(unique_name(property), property.type));
    }
  }
  made.layout = packed_layout(columns);
  return made;
}

// Joined rows with the bytes of colours as one value of four bytes, blue lowest.
class PackedRows final : public InputRows {
 public:
  PackedRows(const FileScan& scan, const Converted& made)
      : rows_(joined_rows(scan, made.layout)), made_(made) {}

  std::size_t next(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) override {
    const std::size_t count = rows_->next(max_rows, stride, block);
    if (!made_.colour) return count;
    const std::size_t end = *made_.colour + made_.channels;
    for (std::size_t row = 0; row < count; ++row) {
      std::byte* const colour = &block[row * stride + *made_.colour];
      if (made_.channels == 3) {
        std::memmove(colour + 4, colour + 3, made_.layout.stride - end);
        colour[3] = std::byte{0};
      }
      std::swap(colour[0], colour[2]);
    }
    return count;
  }

 private:
  std::unique_ptr<InputRows> rows_;
  const Converted& made_;
};

constexpr std::uint64_t kMostRows = 0xffff'ffff;  // WIDTH has 32 bits in PCL

void check_rows(const std::string& name, std::uint64_t rows) {
  if (rows > kMostRows)
    throw Error(name + ": " + std::to_string(rows) + " points, and a PCD file holds at most " +
                std::to_string(kMostRows) + "; --points-format ply or las holds more");
}

}  // namespace

void check_points_pcd(const FileScan& scan, const OutputConfig&) {
  check_rows("points.pcd", scan.expected_points().value_or(0));
}

std::uint64_t pcd_row_bytes(const FileScan& scan, const OutputConfig& config) {
  const std::vector<ResultColumn> results = result_columns(scan, config);
  std::uint64_t bytes = bytes_of(results);
  const auto kept = kept_fields(scan, results);
  const auto fields = kept ? kept->header.fields : converted_fields(scan, results).fields;
  for (const PcdField& field : fields) bytes += field.bytes();
  return bytes;
}

void write_points_pcd(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out) {
  const std::vector<ResultColumn> results = result_columns(scan, config);
  const std::uint64_t rows = detection.summary().counts.points;
  check_rows(out.path().string(), rows);

  const std::optional<Kept> kept = kept_fields(scan, results);
  Converted made;
  PcdHeader header;
  std::unique_ptr<InputRows> input;
  if (kept) {
    header = kept->header;
    input = std::make_unique<KeptRows>(scan, kept->parts);
  } else {
    made = converted_fields(scan, results);
    header.fields = made.fields;
    header.width = rows;
    input = std::make_unique<PackedRows>(scan, made);
  }
  if (header.width * header.height != rows) {
    header.width = rows;
    header.height = 1;
  }
  header.rows = rows;
  header.encoding = PcdEncoding::kBinary;
  const std::size_t input_bytes = header.row_bytes();
  for (const ResultColumn& result : results)
    header.fields.push_back(field_of(pcd_name_of(result.name), result.type));
  out.write(print_pcd_header(header));
  for_each_annotated_block(detection, *input, input_bytes, results, out.path().string(),
                           [&](const auto& block, std::size_t) { out.write(block); });
}

}  // namespace lacuna
