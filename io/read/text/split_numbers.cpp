// SPDX-License-Identifier: Apache-2.0
#include "io/read/text/split_numbers.hpp"

#include "io/read/text/text_cells.hpp"

#include <algorithm>
#include <vector>

namespace lacuna::io {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr std::size_t kCoordinates = 6;  // parts of x y z

bool is_digits(std::string_view cell) {
  return !cell.empty() && cell.find_first_not_of(kDigits) == cell.npos;
}

std::string_view without_sign(std::string_view cell) {
  return cell.substr(cell.starts_with('-') || cell.starts_with('+') ? 1 : 0);
}

std::string_view before_decimals(std::string_view cell) {
  return cell.substr(0, cell.find_first_of(".,"));
}

// What a column has in all rows.
struct ColumnForm {
  bool is_whole = true, is_unsigned = true, is_digit = true;  // a digit alone
  bool begins_thousands = true, is_thousands = true;          // up to three digits; exactly three
  bool has_leading_zero = false;                              // in a row

  void take(std::string_view cell) {
    const std::string_view whole = before_decimals(without_sign(cell));
    is_whole = is_whole && is_digits(without_sign(cell));
    is_unsigned = is_unsigned && without_sign(cell) == cell;
    is_digit = is_digit && cell.size() == 1;
    begins_thousands = begins_thousands && is_digits(whole) && whole.size() <= 3;
    is_thousands = is_thousands && is_digits(whole) && whole.size() == 3;
    has_leading_zero = has_leading_zero || (whole.size() > 1 && whole.front() == '0');
  }
};

// Empty if rows have different numbers of values.
std::vector<ColumnForm> forms_of(std::span<const Line> rows, char separator) {
  std::vector<ColumnForm> forms;
  for (const Line& row : rows) {
    const Cells cells = split(row.text, separator);
    if (forms.empty()) forms.resize(cells.size());
    if (forms.size() != cells.size()) return {};
    for (std::size_t i = 0; i < cells.size(); ++i) forms[i].take(cells[i]);
  }
  return forms;
}

bool are_decimals_split(std::span<const ColumnForm> forms, std::size_t rows) {
  constexpr std::size_t kFewestRows = 10;
  forms = forms.first(std::min(forms.size(), kCoordinates));
  if (forms.size() + 1 < kCoordinates || !std::ranges::all_of(forms, &ColumnForm::is_whole)) return false;
  bool has_zero = false, are_digits = forms.size() == kCoordinates && rows >= kFewestRows &&
                                      !forms[0].is_digit && !forms[2].is_digit;
  for (std::size_t i = 1; i < forms.size(); i += 2) {
    if (!forms[i].is_unsigned) return false;
    has_zero = has_zero || forms[i].has_leading_zero;
    are_digits = are_digits && forms[i].is_digit;
  }
  return has_zero || are_digits;
}

// Numbers of several groups of digits, with decimals behind the last one.
bool are_thousands_split(std::span<const ColumnForm> forms) {
  int split_numbers = 0;
  for (std::size_t i = 0; i + 1 < forms.size(); ++i) {
    if (!forms[i].begins_thousands) continue;
    bool has_zero = false;
    std::size_t last = i;
    while (last + 1 < forms.size() && forms[last].is_whole && forms[last + 1].is_thousands &&
           forms[last + 1].is_unsigned) {
      has_zero = has_zero || forms[++last].has_leading_zero;
    }
    if (last == i || forms[last].is_whole) continue;
    if (has_zero || ++split_numbers == 2) return true;
    i = last;
  }
  return false;
}

}  // namespace

std::string doubt_of_split_numbers(std::span<const Line> rows, char separator) {
  const std::vector<ColumnForm> forms = forms_of(rows, separator);
  if (separator == ',' && are_decimals_split(forms, rows.size()))
    return "commas divide the values, and may begin their decimals, too";
  if ((separator != ' ' && separator != ',') || !are_thousands_split(forms)) return {};
  return std::string(separator == ',' ? "commas" : "blanks") +
         " divide the values, and may divide the thousands of numbers, too";
}

}  // namespace lacuna::io
