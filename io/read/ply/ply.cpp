// SPDX-License-Identifier: Apache-2.0
#include "io/read/ply/ply_header.hpp"

#include "io/read/files/number.hpp"
#include "io/read/files/property_name.hpp"
#include "io/read/rows/scalar.hpp"

#include <set>
#include <span>

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

}  // namespace lacuna::io
