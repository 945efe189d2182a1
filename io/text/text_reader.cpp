// SPDX-License-Identifier: Apache-2.0
#include "io/text/text_reader.hpp"

#include "io/files/input_file.hpp"
#include "io/files/number.hpp"
#include "io/rows/scalar.hpp"
#include "io/text/text_columns.hpp"

#include <cstring>
#include <limits>
#include <utility>

namespace lacuna::io {
namespace {

std::string_view without_end(std::string_view line) {
  return line.substr(0, line.find_last_not_of(" \t\r\v\f") + 1);
}

class TextReader final : public ScanReader {
 public:
  TextReader(const std::filesystem::path& file, const ReadOptions& options)
      : in_(file), columns_(find_text_columns(in_, options.columns)), block_rows_(columns_.block_rows) {
    std::vector<std::pair<std::string, Scalar>> columns;
    for (const std::string& name : columns_.names) {
      is_position_.push_back(name == "x" || name == "y" || name == "z");
      columns.emplace_back(name, Scalar::kFloat64);
    }
    layout_ = packed_layout(columns);
    while (in_.line() < columns_.lines_before && in_.next_line()) {
    }
  }

  std::string format() const override { return "text"; }
  const RowLayout& layout() const override { return layout_; }

  bool is_geographic() const override { return columns_.are_degrees; }

  // A file of counted rows may have more such blocks behind the first.
  std::optional<std::uint64_t> expected_rows() const override { return std::nullopt; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    return fill_batch(batch, max_rows, layout_.stride, [&](std::byte* to) {
      while (const auto line = in_.next_line()) {
        const std::string_view text = without_blanks(*line);
        if (text.empty() || is_comment(text) || begins_block(text)) continue;
        put_row(text, to);
        return true;
      }
      if (block_rows_ && rows_ < *block_rows_) fail_number_of_rows("the file ends here with fewer");
      return false;
    });
  }

 private:
  // Reads, in a file of counted rows, a bare count behind the rows of a block. Exports of several stations
  // have such counts.
  bool begins_block(std::string_view line) {
    std::uint64_t count = 0;
    if (rows_ != block_rows_ || !parse_number(without_end(line), count)) return false;
    block_rows_ = count;
    rows_ = 0;
    return true;
  }

  void put_row(std::string_view row, std::byte* to) {
    if (rows_ == block_rows_) fail_number_of_rows("more");
    parse_row(row, to);
    ++rows_;
  }

  void parse_row(std::string_view rest, std::byte* to) const {
    std::string_view field;
    for (std::size_t i = 0; i < layout_.properties.size(); ++i) {
      const Property& property = layout_.properties[i];
      double value;
      if (!next_field(rest, columns_.separator, field)) {
        value = missing_value(i);
      } else if (!parse_value(field, value) && !parse_value(unquoted(field), value)) {
        value = value_of_text(i, unquoted(field));
      }
      std::memcpy(to + property.offset, &value, sizeof(value));
    }
    if (!columns_.has_list && next_field(rest, columns_.separator, field)) fail_number_of_values("more");
  }

  // Programs leave out empty cells at the end of a row.
  double missing_value(std::size_t column) const {
    if (is_position_[column] || columns_.separator == ' ') fail_number_of_values("fewer");
    return std::numeric_limits<double>::quiet_NaN();
  }

  // Text in another column than x, y and z, and an empty cell, are no number.
  double value_of_text(std::size_t column, std::string_view field) const {
    if (is_position_[column] && !field.empty())
      in_.fail_at_line(in_.line(), in_quotes(field) + " is not a number");
    return std::numeric_limits<double>::quiet_NaN();
  }

  [[noreturn]] void fail_number_of_values(const std::string& comparison) const {
    in_.fail_at_line(in_.line(), comparison + " values than the " +
                                     std::to_string(layout_.properties.size()) +
                                     " columns; every row must have one for each");
  }

  [[noreturn]] void fail_number_of_rows(const std::string& comparison) const {
    in_.fail_at_line(in_.line(), comparison + " rows than the " + std::to_string(*block_rows_) +
                                     " that a line before them declares");
  }

  InputFile in_;
  TextColumns columns_;
  std::vector<bool> is_position_;  // whether a column is x, y or z
  RowLayout layout_;
  std::optional<std::uint64_t> block_rows_;  // of the current block, where its rows are counted
  std::uint64_t rows_ = 0;                   // of it so far
};

}  // namespace

bool looks_like_text(const FileStart& start) {
  return start.first_bytes.find('\0') == std::string_view::npos;
}

std::unique_ptr<ScanReader> open_text(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<TextReader>(file, options);
}

}  // namespace lacuna::io
