// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/little_endian.hpp"
#include "io/read/files/number.hpp"
#include "io/read/ply/ply_rows.hpp"
#include "io/read/rows/scalar.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {
namespace {

[[noreturn]] void fail_few_rows(const InputFile& in, const PlyElement& element, std::uint64_t missing) {
  in.fail_at_line(in.line() + 1, "the file ends here, but " + std::to_string(missing) + " more of the " +
                                     std::to_string(element.count) + " rows of element " +
                                     in_quotes(element.name) + " should follow");
}

std::string few_values(const PlyElement& element) {
  return "fewer values than element " + in_quotes(element.name) +
         " has properties; one row per line is needed";
}

std::string many_values(const PlyElement& element) {
  return "more values than element " + in_quotes(element.name) +
         " has properties; one row per line is needed";
}

template <class T>
std::string not_a_value(const PlyProperty& property, std::string_view word) {
  return in_quotes(word) + " for property " + in_quotes(property.name) + " is not " + describe_number<T>();
}

// Returns the number before the values of a list.
std::uint32_t parse_count(const InputFile& in, std::uint64_t line, const PlyProperty& property,
                          std::string_view word) {
  std::uint32_t count = 0;
  if (!parse_number(word, count)) in.fail_at_line(line, not_a_value<std::uint32_t>(property, word));
  return count;
}

// Takes the values of one row off its line.
struct RowParser {
  const InputFile& in;
  const PlyElement& element;
  std::string_view rest;

  std::string_view word() {
    std::string_view word;
    if (!next_field(rest, ' ', word)) in.fail_at_line(in.line(), few_values(element));
    return word;
  }

  void skip_list(const PlyProperty& property) {
    for (auto left = parse_count(in, in.line(), property, word()); left > 0; --left) word();
  }

  // Moves `to` behind the value.
  void scalar(const PlyProperty& property, std::byte*& to) {
    const std::string_view text = word();
    with_type(property.type, [&](auto value) {
      using T = decltype(value);
      if (!parse_number(text, value)) in.fail_at_line(in.line(), not_a_value<T>(property, text));
      store_next(to, value);
    });
  }
};

bool is_blank_line(std::string_view line) {
  std::string_view word;
  return !next_field(line, ' ', word);
}

std::int64_t parse_integer(const InputFile& in, const PlyProperty& property, std::string_view word) {
  return with_type(property.type, [&](auto value) {
    using T = decltype(value);
    if (!parse_number(word, value)) in.fail_at_line(in.line() + 1, not_a_value<T>(property, word));
    return static_cast<std::int64_t>(value);
  });
}

// Passes over rows and hands on one list of each. `list` is an index into the properties; an index beyond
// them hands on no list. The function reads by words, since a list (of a triangle strip, say) may be longer
// than any buffer.
template <class Visit>
void pass_rows(InputFile& in, const PlyElement& element, std::uint64_t count, std::size_t list,
               const Visit& visit) {
  if (element.properties.empty()) return;
  const auto word = [&] {
    const auto word = in.next_word();
    if (!word) in.fail_at_line(in.line() + 1, few_values(element));
    return *word;
  };
  std::vector<std::int64_t> values;
  for (; count > 0; --count) {
    if (!in.next_row()) fail_few_rows(in, element, count);
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      const std::string_view first = word();
      if (!property.count_type) continue;
      if (i == list) values.clear();
      for (auto left = parse_count(in, in.line() + 1, property, first); left > 0; --left) {
        const std::string_view value = word();
        if (i == list) values.push_back(parse_integer(in, property, value));
      }
    }
    if (!in.end_row()) in.fail_at_line(in.line() + 1, many_values(element));
    visit(values);
  }
}

}  // namespace

void read_ascii_rows(InputFile& in, const PlyElement& element, std::uint64_t count, std::byte* rows) {
  while (count > 0) {
    const auto line = in.next_line();
    if (!line) fail_few_rows(in, element, count);
    if (is_blank_line(*line)) continue;
    RowParser parser{.in = in, .element = element, .rest = *line};
    for (const PlyProperty& property : element.properties) {
      if (property.count_type) {
        parser.skip_list(property);
      } else {
        parser.scalar(property, rows);
      }
    }
    if (!is_blank_line(parser.rest)) in.fail_at_line(in.line(), many_values(element));
    --count;
  }
}

void skip_ascii_rows(InputFile& in, const PlyElement& element, std::uint64_t count) {
  pass_rows(in, element, count, element.properties.size(), [](std::span<const std::int64_t>) {});
}

void skip_ascii_lines(InputFile& in, const PlyElement& element) {
  if (element.properties.empty()) return;
  for (std::uint64_t left = element.count; left > 0; --left) {
    if (!in.next_row()) fail_few_rows(in, element, left);
    in.next_line();
  }
}

void visit_ascii_lists(InputFile& in, const PlyElement& element, std::size_t list, const ListVisitor& visit) {
  pass_rows(in, element, element.count, list, visit);
}

}  // namespace lacuna::io
