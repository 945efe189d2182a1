// SPDX-License-Identifier: Apache-2.0
// The format: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
#include "io/numpy/numpy_reader.hpp"

#include "io/files/input_file.hpp"
#include "io/files/number.hpp"
#include "io/files/property_name.hpp"
#include "io/rows/column_rules.hpp"
#include "io/rows/scalar.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <set>
#include <utility>

namespace lacuna::io {
namespace {

constexpr std::string_view kMagic{"\x93NUMPY", 6};
constexpr std::size_t kMostHeaderBytes = std::size_t{1} << 19;

// A number of a row of the file. 64-bit integers have no `Scalar`.
struct NumpyField {
  std::string name;
  Scalar type = Scalar::kFloat64;
  char wide = 0;  // 'i' or 'u' for a 64-bit integer
  bool is_big = false;
  std::size_t offset = 0;

  std::size_t bytes() const { return size_of(type); }
};

struct NumpyHeader {
  std::vector<NumpyField> fields;  // of a row
  std::uint64_t rows = 0;
  std::size_t row_bytes = 0;
  bool is_fortran = false;
  bool has_names = false;
};

// The literals of Python in a header: a dictionary of texts, lists, tuples, numbers and truths.
class HeaderText {
 public:
  HeaderText(const InputFile& in, std::string_view text) : in_(in), rest_(text) {}

  bool take(char c) {
    while (!rest_.empty() && kBlanks.find(rest_.front()) != kBlanks.npos) rest_.remove_prefix(1);
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void need(char c) {
    if (!take(c)) fail();
  }
  bool is_next(char c) const {
    const std::size_t at = rest_.find_first_not_of(kBlanks);
    return at != rest_.npos && rest_[at] == c;
  }
  std::string text() {
    const char quote = take('\'') ? '\'' : '"';
    if (quote == '"') need('"');
    const std::size_t end = rest_.find(quote);
    if (end == rest_.npos) fail();
    std::string value(rest_.substr(0, end));
    rest_.remove_prefix(end + 1);
    return value;
  }
  bool truth() {
    take(' ');
    for (const bool value : {true, false}) {
      const std::string_view word = value ? "True" : "False";
      if (!rest_.starts_with(word)) continue;
      rest_.remove_prefix(word.size());
      return value;
    }
    fail();
  }
  std::vector<std::uint64_t> shape() {
    std::vector<std::uint64_t> sizes;
    need('(');
    while (!take(')')) {
      take(' ');
      const std::string_view digits = rest_.substr(0, rest_.find_first_not_of("0123456789"));
      std::uint64_t size = 0;
      if (!parse_number(digits, size) || sizes.size() > 32) fail();
      rest_.remove_prefix(digits.size());
      if (rest_.starts_with('L')) rest_.remove_prefix(1);  // of Python 2
      sizes.push_back(size);
      take(',');
    }
    return sizes;
  }
  [[noreturn]] void fail() const {
    in_.fail_at_byte(10, "the header is not one of NumPy; it must be complete");
  }

 private:
  const InputFile& in_;
  std::string_view rest_;
};

NumpyField parse_type(const InputFile& in, const std::string& code) {
  static constexpr std::pair<std::string_view, Scalar> kTypes[] = {
      {"i1", Scalar::kInt8},    {"u1", Scalar::kUint8},   {"b1", Scalar::kUint8},  {"i2", Scalar::kInt16},
      {"u2", Scalar::kUint16},  {"i4", Scalar::kInt32},   {"u4", Scalar::kUint32}, {"f4", Scalar::kFloat32},
      {"f8", Scalar::kFloat64}, {"i8", Scalar::kFloat64}, {"u8", Scalar::kFloat64}};
  NumpyField field;
  for (const auto& [name, type] : kTypes) {
    if (code.size() != 3 || code.substr(1) != name) continue;
    field.type = type;
    field.is_big = code[0] == '>';
    if (name == "i8" || name == "u8") field.wide = name[0];
    return field;
  }
  in.fail_at_byte(10, "values of the type " + in_quotes(code) +
                          "; allowed: integers of 1 to 8 bytes, and floats of 4 or 8 bytes");
}

void check_columns(const InputFile& in, std::size_t columns) {
  if (columns > kMostColumns) in.fail_at_byte(10, kTooManyColumns);
}

// Fields of a structured type: ('x', '<f4') or ('xyz', '<f4', (3,)). A type of V is padding.
void parse_fields(const InputFile& in, HeaderText& text, NumpyHeader& header) {
  header.has_names = true;
  while (!text.take(']')) {
    text.need('(');
    const std::string name = text.text();
    text.need(',');
    if (text.is_next('[')) in.fail_at_byte(10, "fields within fields; each must be a number");
    const std::string code = text.text();
    std::uint64_t count = 1;
    const bool is_list = text.take(',') && text.is_next('(');
    if (is_list) {
      for (const std::uint64_t size : text.shape()) {
        if (size > kMostColumns || (count *= size) > kMostColumns) check_columns(in, kMostColumns + 1);
      }
    }
    text.need(')');
    text.take(',');
    if (code.size() > 2 && code[1] == 'V') {
      std::uint64_t bytes = 0;
      if (!parse_number(std::string_view(code).substr(2), bytes) || bytes > kMostHeaderBytes) text.fail();
      header.row_bytes += bytes;
      continue;
    }
    const NumpyField field = parse_type(in, code);
    check_columns(in, header.fields.size() + count);
    const std::string bare = bare_name(name);
    const bool is_position = count == 3 && (bare == "xyz" || bare.starts_with("pos") || bare == "points");
    for (std::size_t i = 0; i < count; ++i) {
      NumpyField& one = header.fields.emplace_back(field);
      one.name = !is_list      ? property_name(name)
                 : is_position ? std::string(1, "xyz"[i])
                               : property_name(name) + "_" + std::to_string(i);
      one.offset = header.row_bytes;
      header.row_bytes += one.bytes();
    }
  }
}

// Gives the columns of a plain array: the last axis. Other axes count points.
void lay_out(const InputFile& in, const NumpyField& type, const std::vector<std::uint64_t>& shape,
             NumpyHeader& header) {
  std::uint64_t columns = shape.size() < 2 ? 1 : shape.back();
  if (!header.has_names) {
    if (shape.size() < 2 || columns < 3 ||
        (shape.size() == 2 && shape[0] >= 3 && shape[0] < 10 && columns >= 10))
      in.fail_at_byte(
          10, "an array of " + [&] {
            std::string text;
            for (const std::uint64_t size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
            return text.empty() ? std::string("one value") : text;
          }() + "; N x 3 or more are needed, such as its transpose");
    check_columns(in, static_cast<std::size_t>(std::min<std::uint64_t>(columns, kMostColumns + 1)));
    for (std::size_t i = 0; i < columns; ++i) {
      NumpyField& field = header.fields.emplace_back(type);
      field.name = i < 3 ? std::string(1, "xyz"[i]) : "column_" + std::to_string(i + 1);
      field.offset = header.row_bytes;
      header.row_bytes += field.bytes();
    }
  }
  if (header.is_fortran && !header.has_names && shape.size() > 2)
    in.fail_at_byte(10, "more than two axes in the order of Fortran; N x 3 or more are needed");
  header.rows = 1;
  for (std::size_t i = 0; i < shape.size() - (header.has_names || shape.empty() ? 0 : 1); ++i) {
    if (shape[i] != 0 && header.rows > std::numeric_limits<std::uint64_t>::max() / shape[i])
      in.fail_at_byte(10, "too many rows");
    header.rows *= shape[i];
  }
}

NumpyHeader read_header(InputFile& in) {
  const std::string_view start = in.peek(12);
  if (start.size() < 12) in.fail_at_byte(start.size(), "the file ends here, within its header");
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(start[i]));
  };
  const std::size_t length_bytes = byte(6) == 1 ? 2 : 4;
  std::size_t length = 0;
  for (std::size_t i = 0; i < length_bytes; ++i) length |= byte(8 + i) << 8 * i;
  in.skip(8 + length_bytes);
  if (length > kMostHeaderBytes || length > in.remaining())
    in.fail_at_byte(8, "a header of " + std::to_string(length) + " bytes; the file must be complete");
  const std::string bytes(in.peek(length));
  in.skip(length);
  HeaderText text(in, bytes);
  NumpyHeader header;
  NumpyField type;
  std::vector<std::uint64_t> shape;
  bool has_type = false, has_shape = false;
  text.need('{');
  while (!text.take('}')) {
    const std::string key = text.text();
    text.need(':');
    if (key == "descr" && !has_type) {
      has_type = true;
      if (text.take('[')) {
        parse_fields(in, text, header);
      } else {
        type = parse_type(in, text.text());
      }
    } else if (key == "fortran_order") {
      header.is_fortran = text.truth();
    } else if (key == "shape") {
      shape = text.shape();
      has_shape = true;
    } else {
      text.fail();
    }
    text.take(',');
  }
  if (!has_type || !has_shape) text.fail();
  lay_out(in, type, shape, header);
  if (header.row_bytes == 0 || header.rows > in.remaining() / header.row_bytes)
    in.fail_at_byte(in.position() + in.remaining(), "the file ends here, too early for the " +
                                                        std::to_string(header.rows) +
                                                        " rows of its header; it must be complete");
  if (header.rows * header.row_bytes != in.remaining())
    in.fail_at_byte(in.position() + header.rows * header.row_bytes, "more bytes than the rows of the header");
  return header;
}

class NumpyReader final : public ScanReader {
 public:
  NumpyReader(const std::filesystem::path& file, const ReadOptions& options)
      : in_(file), header_(read_header(in_)), begin_(in_.position()) {
    name_columns(options);
    std::vector<std::pair<std::string, Scalar>> columns;
    for (const NumpyField& field : header_.fields) columns.emplace_back(field.name, field.type);
    layout_ = packed_layout(columns);
    check_values(options);
  }

  std::string format() const override { return "NumPy"; }
  const RowLayout& layout() const override { return layout_; }
  std::optional<std::uint64_t> expected_rows() const override { return header_.rows; }
  bool is_geographic() const override { return is_geographic_; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    const std::size_t fitting = std::max<std::size_t>(1, kBatchBytes / header_.row_bytes);
    batch.count =
        static_cast<std::size_t>(std::min<std::uint64_t>(header_.rows - row_, std::min(max_rows, fitting)));
    batch.bytes.resize(batch.count * layout_.stride);
    if (batch.count == 0) return false;
    const bool by_columns = header_.is_fortran && !header_.has_names;
    if (!by_columns) {
      raw_.resize(batch.count * header_.row_bytes);
      in_.read_at(begin_ + row_ * header_.row_bytes, raw_);
    }
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      const NumpyField& field = header_.fields[i];
      if (by_columns) {
        raw_.resize(batch.count * field.bytes());
        in_.read_at(begin_ + (i * header_.rows + row_) * field.bytes(), raw_);
      }
      copy(field, by_columns ? raw_.data() : raw_.data() + field.offset,
           by_columns ? field.bytes() : header_.row_bytes,
           {batch.bytes.data() + layout_.properties[i].offset, layout_.stride, field.type}, batch.count);
    }
    row_ += batch.count;
    return true;
  }

 private:
  static void copy(const NumpyField& field, const std::byte* from, std::size_t stride, Column to,
                   std::size_t count) {
    copy_column({from, stride, field.type}, to, count);
    if (field.is_big) swap_bytes(to, count);
    if (field.wide == 0) return;
    for (std::size_t i = 0; i < count; ++i) {
      std::int64_t whole = 0;
      std::memcpy(&whole, to.data + i * to.stride, sizeof whole);
      const double value = field.wide == 'i' ? static_cast<double>(whole)
                                             : static_cast<double>(static_cast<std::uint64_t>(whole));
      std::memcpy(to.data + i * to.stride, &value, sizeof value);
    }
  }

  void name_columns(const ReadOptions& options) {
    std::vector<std::string> names;
    for (const NumpyField& field : header_.fields) names.push_back(field.name);
    if (!header_.has_names && !options.columns.empty() && options.columns.find('=') == std::string::npos) {
      std::string_view rest = options.columns, word;
      std::vector<std::string> given;
      while (next_field(rest, ' ', word)) given.push_back(property_name(word));
      if (given.size() == names.size()) names = given;
    }
    const PositionNames position = name_position(names);
    if (position == PositionNames::kNone)
      in_.fail_at_byte(10, "no fields named x, y and z, but " + in_quotes(names.empty() ? "" : names[0]) +
                               " first; numpy.lib.recfunctions.rename_fields names them");
    is_geographic_ = position == PositionNames::kDegrees;
    std::set<std::string> seen;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!seen.insert(names[i]).second)
        in_.fail_at_byte(10, "a second field " + in_quotes(names[i]) + "; names must differ");
      header_.fields[i].name = names[i];
    }
  }

  // Refuses columns without names that may not be x y z.
  void check_values(const ReadOptions& options) {
    constexpr std::size_t kSampled = 4096;
    RowBatch batch;
    if (!next(batch, kSampled)) return;
    row_ = 0;
    SampledRows rows{.columns = header_.fields.size(), .values = {}};
    const std::size_t count = std::min(batch.count, std::max<std::size_t>(10, (1 << 16) / rows.columns));
    for (std::size_t row = 0; row < count; ++row) {
      for (const Property& property : layout_.properties) {
        double value = 0;
        copy_column(
            {batch.bytes.data() + row * layout_.stride + property.offset, layout_.stride, property.type},
            {reinterpret_cast<std::byte*>(&value), sizeof value, Scalar::kFloat64}, 1);
        rows.values.push_back(value);
      }
    }
    if (header_.has_names || !options.columns.empty()) return;
    if (is_matrix(rows)) in_.fail_at_byte(10, describe_matrix(header_.rows, rows.columns));
    if (const std::string doubt = doubt_of_first_columns(rows); !doubt.empty())
      in_.fail_at_byte(begin_, "no names of columns, and " + doubt +
                                   "; --columns says what the columns are, such as --columns id,x,y,z or "
                                   "--columns x,y,z,a");
  }

  InputFile in_;
  NumpyHeader header_;
  std::uint64_t begin_;  // of the rows, in the file
  std::uint64_t row_ = 0;
  RowLayout layout_;
  std::vector<std::byte> raw_;
  bool is_geographic_ = false;
};

}  // namespace

bool looks_like_numpy(const FileStart& start) {
  return start.first_bytes.starts_with(kMagic);
}

std::unique_ptr<ScanReader> open_numpy(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<NumpyReader>(file, options);
}

}  // namespace lacuna::io
