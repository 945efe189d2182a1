// SPDX-License-Identifier: Apache-2.0
#include "io/read/text/text_reader.hpp"

#include "io/read/files/input_file.hpp"
#include "io/read/files/little_endian.hpp"
#include "io/read/files/number.hpp"
#include "io/read/rows/scalar.hpp"
#include "io/read/text/text_cells.hpp"
#include "io/read/text/text_columns.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace lacuna::io {
namespace {

class TextReader final : public ScanReader {
 public:
  TextReader(const std::filesystem::path& file, const ReadOptions& options)
      : in_(file), columns_(find_text_columns(in_, options.columns)), block_rows_(columns_.block_rows) {
    std::vector<std::pair<std::string, Scalar>> columns;
    for (const std::string& name : columns_.names) {
      is_read_.push_back(name != kNotRead);
      if (is_read_.back()) columns.emplace_back(name, Scalar::kFloat64);
    }
    layout_ = packed_layout(columns);
  }

  std::string format() const override { return "text"; }
  const RowLayout& layout() const override { return layout_; }
  bool is_geographic() const override { return columns_.are_degrees; }
  RowFindings findings() const override { return findings_; }

  // A file of counted rows may have more such blocks behind the first.
  std::optional<std::uint64_t> expected_rows() const override { return std::nullopt; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    const bool has_rows = fill_batch(batch, max_rows, layout_.stride, [&](std::byte* to) {
      if (!columns_.first_row.empty()) {
        put_row(std::exchange(columns_.first_row, {}), to);
        return true;
      }
      while (const auto line = in_.next_line()) {
        const std::string_view text = without_blanks(*line);
        if (text.empty() || is_comment(text) || begins_block(text) || is_repeated(text)) continue;
        put_row(text, to);
        return true;
      }
      return false;
    });
    if (!has_rows && block_rows_ && rows_ < *block_rows_)
      fail_number_of_rows("the file ends here with fewer");
    return has_rows;
  }

 private:
  // Files that were joined have their headers within.
  bool is_repeated(std::string_view line) {
    const bool is_one =
        std::ranges::find(columns_.lines_before, without_end(line)) != columns_.lines_before.end();
    findings_.repeated_lines += is_one ? 1 : 0;
    return is_one;
  }

  // Reads, in a file of counted rows, a bare count behind the rows of a block. Exports of several stations
  // have such counts.
  bool begins_block(std::string_view line) {
    std::uint64_t count = 0;
    if (rows_ != block_rows_ || !parse_number(without_end(line), count)) return false;
    block_rows_ = count;
    rows_ = 0;
    return true;
  }

  void put_row(std::string_view rest, std::byte* to) {
    if (rows_ == block_rows_) fail_number_of_rows("more");
    ++rows_;
    const std::string_view row = rest;
    std::string_view cell;
    for (std::size_t i = 0; i < is_read_.size(); ++i) {
      double value;
      if (is_read_[i] && take_number(rest, columns_.separator, value)) {
        store_next(to, value);
        continue;
      }
      if (!next_cell(rest, columns_.separator, cell)) {
        // No field follows a last separator, but an empty cell does.
        if (i + 1 < is_read_.size() || i == 0 || columns_.separator == ' ' ||
            without_end(row).back() != columns_.separator)
          fail_number_of_values("fewer");
        cell = {};
      }
      if (!is_read_[i]) continue;
      if (!parse_cell(cell, value)) {
        if (!is_missing(cell)) fail_number(cell, row);
        value = std::numeric_limits<double>::quiet_NaN();
      }
      store_next(to, value);
    }
    if (!columns_.has_more && next_cell(rest, columns_.separator, cell)) fail_number_of_values("more");
  }

  // Whether signs divide the digits of a number; bytes above 127 are of blanks and quotes.
  static bool has_thousands(std::string_view cell) {
    constexpr std::string_view kBetween = ".,' \xa0\x80",
                               kOthers = "0123456789+-.,' \xa0\x80\xc2\xe2\xaf\x99";
    const std::size_t first = cell.find_first_of(kBetween);
    return first != cell.npos && first > 0 && cell.find_first_not_of(kOthers) == cell.npos;
  }

  [[noreturn]] void fail_number(std::string_view cell, std::string_view row) const {
    const bool is_header = count_numbers(split(row, columns_.separator)) == 0;
    in_.fail_at_line(
        in_.line(),
        in_quotes(cell) + " is not a number" +
            (has_thousands(cell) ? "; thousands must not be divided"
             : is_header ? ", and no value of its line is; joined files with other columns must be read "
                           "one by one"
                         : "; --columns leaves a column out that has the name _, such as --columns x,y,z,_"));
  }

  [[noreturn]] void fail_number_of_values(const std::string& comparison) const {
    in_.fail_at_line(in_.line(), comparison + " values than the " + std::to_string(is_read_.size()) +
                                     " columns; every row must have one for each");
  }

  [[noreturn]] void fail_number_of_rows(const std::string& comparison) const {
    in_.fail_at_line(in_.line(), comparison + " rows than the " + std::to_string(*block_rows_) +
                                     " that a line before them declares");
  }

  InputFile in_;
  TextColumns columns_;
  RowLayout layout_;
  std::vector<char> is_read_;                // of each column of the file
  std::optional<std::uint64_t> block_rows_;  // of the current block, where its rows are counted
  std::uint64_t rows_ = 0;                   // of it so far
  RowFindings findings_;
};

}  // namespace

bool looks_like_text(const FileStart& start) {
  return start.first_bytes.find('\0') == std::string_view::npos;
}

std::unique_ptr<ScanReader> open_text(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<TextReader>(file, options);
}

}  // namespace lacuna::io
