// SPDX-License-Identifier: Apache-2.0
#include "io/read/ply/ply.hpp"

#include "io/read/files/number.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <set>
#include <utility>

namespace lacuna::io {
namespace {

// The limit is more than any real header has, and little enough to give up on a file without one.
constexpr std::uint64_t kLongestHeader = 1 << 20;

constexpr const char* kTypes =
    "char, uchar, short, ushort, int, uint, float and double (or int8, ... float64)";

using Words = std::span<const std::string_view>;

// The parts of the header that have been read so far.
struct Parser {
  InputFile& in;
  PlyHeader header;
  bool has_format = false;
  std::set<std::string, std::less<>> elements;
  std::set<std::string, std::less<>> properties;  // of the last element

  [[noreturn]] void fail(const std::string& reason) const { in.fail_at_line(in.line(), reason); }
};

void parse_format(Parser& parser, Words words) {
  if (parser.has_format) parser.fail("a second 'format' line; one is allowed");
  if (words.size() != 3 || words[2] != "1.0") parser.fail("'format <encoding> 1.0' is the only one allowed");
  if (words[1] == "ascii") {
    parser.header.format = PlyFormat::kAscii;
  } else if (words[1] == "binary_little_endian") {
    parser.header.format = PlyFormat::kLittleEndian;
  } else if (words[1] == "binary_big_endian") {
    parser.header.format = PlyFormat::kBigEndian;
  } else {
    parser.fail("unknown encoding " + in_quotes(words[1]) +
                "; allowed are ascii, binary_little_endian and binary_big_endian");
  }
  parser.has_format = true;
}

void parse_element(Parser& parser, Words words) {
  if (words.size() != 3) parser.fail("'element <name> <count>' expected");
  PlyElement element{.name = std::string(words[1]), .count = 0, .properties = {}};
  if (!parse_number(words[2], element.count)) {
    parser.fail(in_quotes(words[2]) + " is not " + describe_number<std::uint64_t>());
  }
  if (!parser.elements.insert(element.name).second) {
    parser.fail("a second element " + in_quotes(element.name) + "; names must differ");
  }
  parser.properties.clear();
  parser.header.elements.push_back(std::move(element));
}

Scalar parse_type(const Parser& parser, std::string_view name) {
  const auto type = scalar_from_name(name);
  if (!type) parser.fail("unknown type " + in_quotes(name) + "; allowed are " + kTypes);
  return *type;
}

void parse_property(Parser& parser, Words words) {
  if (parser.header.elements.empty()) parser.fail("a property before the first element");
  const bool list = words.size() == 5 && words[1] == "list";
  if (!list && words.size() != 3) {
    parser.fail("'property <type> <name>' or 'property list <count type> <type> <name>' expected");
  }
  PlyProperty property;
  property.name = std::string(words.back());
  property.type = parse_type(parser, words[words.size() - 2]);
  if (list) {
    property.count_type = parse_type(parser, words[2]);
    if (!is_integer(*property.count_type)) parser.fail("the count of a list must have an integer type");
  }
  PlyElement& element = parser.header.elements.back();
  if (element.properties.size() == kMostColumns) parser.fail(kTooManyColumns);
  if (!parser.properties.insert(property.name).second) {
    parser.fail("a second property " + in_quotes(property.name) + " of element " + in_quotes(element.name) +
                "; names must differ");
  }
  element.properties.push_back(std::move(property));
}

// X Y Z and NX NY NZ are names of position and normal, unless there are x y z too.
void set_known_names(PlyHeader& header) {
  for (PlyElement& element : header.elements) {
    std::set<std::string> names;
    for (const PlyProperty& property : element.properties) names.insert(property.name);
    for (PlyProperty& property : element.properties) {
      std::string name = known_name(property.name);
      if (names.insert(name).second) property.name = std::move(name);
    }
  }
}

// Returns false at the end of the header.
bool parse_line(Parser& parser, Words words) {
  if (words.empty() || words[0] == "obj_info") return true;
  if (words[0] == "comment") {
    read_offset(parser.in, words.subspan(1), parser.header.offset);
    return true;
  }
  if (words[0] == "Created" && words.size() > 1 && words[1] == "by")
    return true;  // of Blender 2.4, without "comment"
  if (words[0] == "end_header") return false;
  if (words[0] == "format") {
    parse_format(parser, words);
  } else if (words[0] == "element") {
    parse_element(parser, words);
  } else if (words[0] == "property") {
    parse_property(parser, words);
  } else if (words.size() == 1 && words[0] == "bye") {
    ++parser.header.byes;
  } else {
    parser.fail("unknown keyword " + in_quotes(words[0]) +
                "; allowed are format, comment, obj_info, element, property and end_header");
  }
  return true;
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::string_view word; next_field(line, ' ', word);) words.push_back(word);
  return words;
}

}  // namespace

const char* ply_name(PlyFormat format) {
  switch (format) {
    case PlyFormat::kLittleEndian:
      return "binary_little_endian";
    case PlyFormat::kBigEndian:
      return "binary_big_endian";
    case PlyFormat::kAscii:
      break;
  }
  return "ascii";
}

bool PlyElement::has_lists() const {
  for (const PlyProperty& property : properties) {
    if (property.count_type) return true;
  }
  return false;
}

RowLayout PlyElement::layout() const {
  std::vector<std::pair<std::string, Scalar>> scalars;
  for (const PlyProperty& property : properties) {
    if (!property.count_type) scalars.emplace_back(property.name, property.type);
  }
  return packed_layout(scalars);
}

PlyHeader read_ply_header(InputFile& in) {
  in.accept_lone_returns();  // of Rhinoceros
  const auto magic = in.next_line();
  if (!magic || split(*magic) != std::vector<std::string_view>{"ply"}) {
    in.fail_at_line(1, "'ply' alone on the first line expected");
  }
  Parser parser{.in = in, .header = {}, .has_format = false, .elements = {}, .properties = {}};
  for (;;) {
    const auto line = in.next_line();
    if (!line) in.fail_at_line(in.line(), "the file ends here, within its header; 'end_header' must follow");
    if (in.position() > kLongestHeader) {
      parser.fail("no 'end_header' in the first " + std::to_string(kLongestHeader) + " bytes");
    }
    if (!parse_line(parser, split(*line))) break;
  }
  if (!parser.has_format) parser.fail("no 'format' line before 'end_header'");
  set_known_names(parser.header);
  return std::move(parser.header);
}

std::string print_ply_header(const PlyHeader& header, std::string_view comment) {
  std::string text = std::string("ply\nformat ") + ply_name(header.format) + " 1.0\n";
  text += "comment " + std::string(comment) + '\n';
  if (header.offset) text += "comment " + print_offset(*header.offset) + '\n';
  for (const PlyElement& element : header.elements) {
    text += "element " + element.name + ' ' + std::to_string(element.count) + '\n';
    for (const PlyProperty& property : element.properties) {
      text += "property ";
      if (property.count_type) text += std::string("list ") + ply_name(*property.count_type) + ' ';
      text += std::string(ply_name(property.type)) + ' ' + property.name + '\n';
    }
  }
  return text + "end_header\n";
}

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

template <class T>
T read_value(InputFile& in, bool swapped) {
  std::array<std::byte, sizeof(T)> bytes;
  in.read(bytes.data(), bytes.size());
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  T value;
  std::memcpy(&value, bytes.data(), bytes.size());
  return value;
}

// Returns at most 2^32 - 1.
std::uint64_t read_count(InputFile& in, const PlyProperty& property, bool swapped) {
  const std::uint64_t place = in.position();
  return with_type(*property.count_type, [&](auto zero) -> std::uint64_t {
    const auto value = read_value<decltype(zero)>(in, swapped);
    if (value < 0) in.fail_at_byte(place, "list " + in_quotes(property.name) + " has a negative count");
    return static_cast<std::uint64_t>(value);
  });
}

void skip_list(InputFile& in, const PlyProperty& property, bool swapped) {
  in.skip(read_count(in, property, swapped) * size_of(property.type));
}

void read_list(InputFile& in, const PlyProperty& property, bool swapped, std::vector<std::int64_t>& values) {
  const std::uint64_t count = read_count(in, property, swapped);
  const std::uint64_t bytes = count * size_of(property.type);
  if (bytes > in.remaining()) in.skip(bytes);  // says what is missing
  values.clear();
  values.reserve(count);
  with_type(property.type, [&](auto zero) {
    for (std::uint64_t i = 0; i < count; ++i) {
      values.push_back(static_cast<std::int64_t>(read_value<decltype(zero)>(in, swapped)));
    }
  });
}

void read_binary_rows(InputFile& in, const PlyElement& element, bool swapped, std::uint64_t count,
                      std::byte* rows) {
  const RowLayout layout = element.layout();
  if (!element.has_lists()) {
    in.read(rows, count * layout.stride);
  } else {
    std::byte* to = rows;
    for (std::uint64_t row = 0; row < count; ++row) {
      for (const PlyProperty& property : element.properties) {
        if (property.count_type) {
          skip_list(in, property, swapped);
        } else {
          in.read(to, size_of(property.type));
          to += size_of(property.type);
        }
      }
    }
  }
  if (!swapped) return;
  for (const Property& property : layout.properties) {
    swap_bytes({.data = rows + property.offset, .stride = layout.stride, .type = property.type}, count);
  }
}

void skip_binary_rows(InputFile& in, const PlyElement& element, bool swapped, std::uint64_t count) {
  if (!element.has_lists()) {
    in.skip(count * element.layout().stride);  // cannot overflow: require_size has seen the count
    return;
  }
  for (; count > 0; --count) {
    for (const PlyProperty& property : element.properties) {
      if (property.count_type) {
        skip_list(in, property, swapped);
      } else {
        in.skip(size_of(property.type));
      }
    }
  }
}

}  // namespace

void visit_ascii_lists(InputFile& in, const PlyElement& element, std::size_t list, const ListVisitor& visit) {
  pass_rows(in, element, element.count, list, visit);
}

void visit_binary_lists(InputFile& in, const PlyElement& element, bool swapped, std::size_t list,
                        const ListVisitor& visit) {
  std::vector<std::int64_t> values;
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (i == list) {
        read_list(in, property, swapped, values);
      } else if (property.count_type) {
        skip_list(in, property, swapped);
      } else {
        in.skip(size_of(property.type));
      }
    }
    visit(values);
  }
}

namespace {

// A row takes at least so many bytes. ASCII: a digit and a blank for each value.
std::uint64_t least_row_bytes(const PlyElement& element, PlyFormat format) {
  if (format == PlyFormat::kAscii) return 2 * element.properties.size();
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : element.properties) {
    bytes += size_of(property.count_type.value_or(property.type));
  }
  return bytes;
}

}  // namespace

void require_size(const InputFile& in, const PlyHeader& header) {
  const std::uint64_t size = in.position() + in.remaining();
  std::uint64_t left = in.remaining();
  if (header.format == PlyFormat::kAscii) ++left;  // the last line may have no end
  for (const PlyElement& element : header.elements) {
    const std::uint64_t least = least_row_bytes(element, header.format);
    if (least > 0 && element.count > left / least) {
      in.fail_at_byte(size, "the file ends here, too early for the " + std::to_string(element.count) +
                                " rows of element " + in_quotes(element.name) +
                                " that its header declares; it must be complete");
    }
    left -= element.count * least;
  }
}

bool is_swapped(PlyFormat format) {
  return format != PlyFormat::kLittleEndian;
}

void read_rows(InputFile& in, PlyFormat format, const PlyElement& element, std::uint64_t count,
               std::byte* rows) {
  if (format == PlyFormat::kAscii) {
    read_ascii_rows(in, element, count, rows);
  } else {
    read_binary_rows(in, element, is_swapped(format), count, rows);
  }
}

void skip_rows(InputFile& in, PlyFormat format, const PlyElement& element) {
  if (format == PlyFormat::kAscii) {
    skip_ascii_rows(in, element, element.count);
  } else {
    skip_binary_rows(in, element, is_swapped(format), element.count);
  }
}

static_assert(std::endian::native == std::endian::little, "values are written as they are in memory");

PlyWriter::PlyWriter(OutputFile& out, std::vector<PlyElement> elements, const LocalOffset& offset,
                     std::uint64_t list_bytes)
    : out_(out), offset_(offset), missing_bytes_(list_bytes) {
  const PlyHeader header{
      .format = PlyFormat::kLittleEndian, .elements = std::move(elements), .offset = offset};
  for (const PlyElement& element : header.elements) missing_bytes_ += element.count * element.layout().stride;
  out_.write(print_ply_header(header, "lacuna detect"));
}

void PlyWriter::put_position(Scalar type, const Eigen::Vector3d& position) {
  const Eigen::Vector3d in_file = offset_ ? position - *offset_ : position;
  std::array<std::byte, sizeof(double)> bytes;
  for (const double coordinate : in_file) {
    put_floating(bytes.data(), type, coordinate);
    put_bytes(std::span(bytes).first(size_of(type)));
  }
}

void PlyWriter::put_as(Scalar type, double value) {
  with_type(type, [&](auto target) { put(static_cast<decltype(target)>(value)); });
}

void PlyWriter::put_bytes(std::span<const std::byte> bytes) {
  assert(bytes.size() <= missing_bytes_);
  missing_bytes_ -= bytes.size();
  out_.write(bytes);
}

void PlyWriter::finish() {
  assert(missing_bytes_ == 0);
}

}  // namespace lacuna::io
