// SPDX-License-Identifier: Apache-2.0
#include "io/read/pcd/pcd_header.hpp"

#include "io/read/files/line_words.hpp"
#include "io/read/files/number.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <array>
#include <limits>
#include <set>
#include <string_view>

namespace lacuna::io {
namespace {

// The limit is more than any real header has, and little enough to give up on a file without one.
constexpr std::uint64_t kLongestHeader = 1 << 20;

// The parts of the header that have been read so far.
struct Parser {
  InputFile& in;
  PcdHeader header;
  std::set<std::string, std::less<>> seen;
  std::optional<std::uint64_t> width, height, points;

  [[noreturn]] void fail(const std::string& reason) const { in.fail_at_line(in.line(), reason); }
};

void parse_version(const Parser& parser, LineWords& words) {
  std::string_view version;
  words.next(version);
  for (const std::string_view allowed : {".5", ".6", ".7", "0.5", "0.6", "0.7"}) {
    if (version == allowed) return;
  }
  parser.fail("version " + in_quotes(version) + "; allowed are .5, .6 and .7");
}

void parse_fields(Parser& parser, LineWords& words) {
  for (std::string_view word; words.next(word);) {
    if (parser.header.fields.size() == kMostColumns) parser.fail(kTooManyColumns);
    parser.header.fields.push_back({.name = std::string(word)});
  }
  if (parser.header.fields.empty()) parser.fail("no fields; x, y and z are needed");
}

// Reads one value for each field, in order.
template <class Parse>
void parse_each(Parser& parser, LineWords& words, const char* keyword, const Parse& parse) {
  if (parser.header.fields.empty())
    parser.fail(std::string(keyword) + " before FIELDS; FIELDS must be first");
  if (words.count_left() != parser.header.fields.size()) {
    parser.fail(std::to_string(words.count_left()) + " values for the " +
                std::to_string(parser.header.fields.size()) + " fields; each must have one");
  }
  for (PcdField& field : parser.header.fields) parse(field);
}

void parse_data(Parser& parser, LineWords& words) {
  std::string_view name;
  words.next(name);
  for (const PcdEncoding encoding : {PcdEncoding::kAscii, PcdEncoding::kBinary, PcdEncoding::kCompressed}) {
    if (name == pcd_name(encoding)) {
      parser.header.encoding = encoding;
      return;
    }
  }
  parser.fail("unknown encoding " + in_quotes(name) + "; allowed are ascii, binary and binary_compressed");
}

// The place, and the quaternion w x y z, which some programs leave out.
Pose parse_viewpoint(LineWords& words) {
  constexpr const char* kNeeded = "a position x y z and a quaternion are needed";
  constexpr double kZero = 1e-6;
  Eigen::Vector3d place;
  for (double& coordinate : place) coordinate = words.number<double>(kNeeded);
  std::array<double, 4> turn = {1, 0, 0, 0};
  if (words.count_left() > 0) {
    for (double& part : turn) part = words.number<double>(kNeeded);
  }
  const Eigen::Quaterniond quaternion(turn[0], turn[1], turn[2], turn[3]);
  Pose pose = Pose::Identity();
  if (quaternion.norm() > kZero) pose.linear() = quaternion.normalized().toRotationMatrix();
  pose.translation() = place;
  return pose;
}

// Returns false at the end of the header.
bool parse_line(Parser& parser, std::string_view line) {
  LineWords words(parser.in, line);
  std::string_view keyword;
  if (!words.next(keyword)) return true;
  if (keyword.starts_with('#')) return true;
  if (keyword == "COLUMNS") keyword = "FIELDS";  // its name in some old files
  if (!parser.seen.insert(std::string(keyword)).second) {
    parser.fail("a second line " + in_quotes(keyword) + "; one is allowed");
  }
  constexpr const char* kCount = "one whole number is needed";
  if (keyword == "VERSION") {
    parse_version(parser, words);
  } else if (keyword == "FIELDS") {
    parse_fields(parser, words);
  } else if (keyword == "SIZE") {
    parse_each(parser, words, "SIZE",
               [&](PcdField& field) { field.size = words.number<std::uint32_t>(kCount); });
  } else if (keyword == "TYPE") {
    parse_each(parser, words, "TYPE", [&](PcdField& field) {
      std::string_view type;
      words.next(type);
      if (type != "I" && type != "U" && type != "F") {
        parser.fail("unknown type " + in_quotes(type) + "; allowed are I, U and F");
      }
      field.type = type[0];
    });
  } else if (keyword == "COUNT") {
    parse_each(parser, words, "COUNT",
               [&](PcdField& field) { field.count = words.number<std::uint32_t>(kCount); });
  } else if (keyword == "WIDTH") {
    parser.width = words.number<std::uint64_t>(kCount);
  } else if (keyword == "HEIGHT") {
    parser.height = words.number<std::uint64_t>(kCount);
  } else if (keyword == "POINTS") {
    parser.points = words.number<std::uint64_t>(kCount);
  } else if (keyword == "DATA") {
    parse_data(parser, words);
    return false;
  } else if (keyword == "VIEWPOINT") {
    parser.header.viewpoint = parse_viewpoint(words);
  } else {
    parser.fail(
        "unknown keyword " + in_quotes(keyword) +
        "; allowed are VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS and DATA");
  }
  return true;
}

void require_types(const Parser& parser) {
  if (parser.header.fields.empty()) parser.fail("no line FIELDS before DATA");
  std::size_t values = 0;
  for (const PcdField& field : parser.header.fields) {
    const std::size_t size = field.size;
    const bool is_known =
        field.type == 'F' ? size == 4 || size == 8 : size == 1 || size == 2 || size == 4 || size == 8;
    if (!is_known) {
      parser.fail("field " + in_quotes(field.name) + " has type " + field.type + " of " +
                  std::to_string(size) + " bytes; allowed are I and U of 1, 2, 4 or 8 bytes and F of 4 or 8");
    }
    // Each count is below 2^32 and the sum stops early, so that it cannot overflow.
    values += field.count;
    if (values > kMostColumns) parser.fail(kTooManyColumns);
  }
}

std::uint64_t count_rows(const Parser& parser) {
  if (!parser.width) {
    if (!parser.points) parser.fail("neither POINTS nor WIDTH before DATA; the number of points is needed");
    return *parser.points;
  }
  const std::uint64_t width = *parser.width, height = parser.height.value_or(1);
  const bool fits = width == 0 || height <= std::numeric_limits<std::uint64_t>::max() / width;
  if (!fits || (parser.points && *parser.points != width * height)) {
    parser.fail("WIDTH " + std::to_string(width) + " times HEIGHT " + std::to_string(height) +
                " is not the number of points" +
                (parser.points ? ", POINTS " + std::to_string(*parser.points) : std::string()) +
                "; they must be equal");
  }
  return width * height;
}

}  // namespace

const char* pcd_name(PcdEncoding encoding) {
  switch (encoding) {
    case PcdEncoding::kBinary:
      return "binary";
    case PcdEncoding::kCompressed:
      return "binary_compressed";
    case PcdEncoding::kAscii:
      break;
  }
  return "ascii";
}

std::size_t PcdHeader::row_bytes() const {
  std::size_t bytes = 0;
  for (const PcdField& field : fields) bytes += field.bytes();
  return bytes;
}

std::optional<Eigen::Vector3d> PcdHeader::scanner() const {
  const Eigen::Vector3d place = viewpoint.translation();
  return place.isZero(0) ? std::nullopt : std::optional(place);
}

std::size_t PcdHeader::padding_bytes() const {
  std::size_t bytes = 0;
  for (const PcdField& field : fields) bytes += field.is_padding() ? field.bytes() : 0;
  return bytes;
}

PcdHeader read_pcd_header(InputFile& in) {
  Parser parser{.in = in, .header = {}, .seen = {}, .width = {}, .height = {}, .points = {}};
  for (;;) {
    const auto line = in.next_line();
    if (!line) in.fail_at_line(in.line(), "the file ends here, within its header; 'DATA' must follow");
    if (in.position() > kLongestHeader) {
      parser.fail("no 'DATA' in the first " + std::to_string(kLongestHeader) + " bytes");
    }
    if (!parse_line(parser, *line)) break;
  }
  require_types(parser);
  parser.header.rows = count_rows(parser);
  // A field without values has no bytes in a row, and no column.
  std::erase_if(parser.header.fields, [](const PcdField& field) { return field.count == 0; });
  if (parser.header.fields.empty()) parser.fail("every field has COUNT 0; x, y and z are needed");
  return std::move(parser.header);
}

}  // namespace lacuna::io
