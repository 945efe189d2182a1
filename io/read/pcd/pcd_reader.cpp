// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/pcd/lzf.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/readers.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {
namespace {

// The header of a PCD file: its fields and how they are stored.
// https://pointclouds.org/documentation/tutorials/pcd_file_format.html

enum class PcdEncoding : std::uint8_t { kAscii, kBinary, kCompressed };

struct PcdField {
  std::string name;
  char type = 'F';       // 'I', 'U' or 'F'
  std::size_t size = 4;  // bytes of a value
  std::size_t count = 1;

  std::size_t bytes() const { return size * count; }
  bool is_padding() const { return name == "_"; }
};

struct PcdHeader {
  std::vector<PcdField> fields;  // at least one, with at most 65,536 values together
  std::uint64_t rows = 0;        // as declared: nothing may be allocated by it
  PcdEncoding encoding = PcdEncoding::kAscii;
  Pose viewpoint = Pose::Identity();  // of the scanner; turns by nothing if its quaternion is 0 0 0 0

  std::size_t row_bytes(bool with_padding = true) const {
    std::size_t bytes = 0;
    for (const PcdField& field : fields) bytes += with_padding || !field.is_padding() ? field.bytes() : 0;
    return bytes;
  }
  // Returns where the scanner is; nothing at 0 0 0, which is the default.
  std::optional<Eigen::Vector3d> scanner() const {
    const Eigen::Vector3d place = viewpoint.translation();
    return place.isZero(0) ? std::nullopt : std::optional(place);
  }
};

// "ascii", "binary", "binary_compressed".
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

// Reads the header with its line DATA. Versions are .5 to .7; without SIZE, TYPE or COUNT, values are single
// floats; WIDTH x HEIGHT must equal POINTS if both are given. Throws `Error` with the line.
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

// The properties of rows that the fields of a PCD file become.

// Calls `visit(T{})` with the C++ type of the field's values.
template <class Visit>
void with_pcd_type(const PcdField& field, const Visit& visit) {
  if (field.type == 'F') return field.size == 4 ? visit(float{}) : visit(double{});
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? visit(std::int8_t{}) : visit(std::uint8_t{});
    case 2:
      return is_signed ? visit(std::int16_t{}) : visit(std::uint16_t{});
    case 4:
      return is_signed ? visit(std::int32_t{}) : visit(std::uint32_t{});
    default:
      return is_signed ? visit(std::int64_t{}) : visit(std::uint64_t{});
  }
}

// The type of its properties.
Scalar scalar_of(const PcdField& field) {
  if (field.size == 8) return Scalar::kFloat64;
  if (field.type == 'F') return Scalar::kFloat32;
  constexpr std::array kSigned = {Scalar::kInt8, Scalar::kInt16, Scalar::kInt32};
  constexpr std::array kUnsigned = {Scalar::kUint8, Scalar::kUint16, Scalar::kUint32};
  const std::size_t rank = std::countr_zero(field.size);
  return field.type == 'I' ? kSigned[rank] : kUnsigned[rank];
}

// Colours as bytes of one value: blue is the lowest, alpha the highest.
bool is_packed_colour(const PcdField& field) {
  return (field.name == "rgb" || field.name == "rgba") && field.size == 4 && field.count == 1;
}

std::string name_of(const PcdField& field) {
  for (const auto& [given, name] :
       {std::pair{"normal_x", "nx"}, std::pair{"normal_y", "ny"}, std::pair{"normal_z", "nz"}}) {
    if (field.name == given) return name;
  }
  return property_name(field.name);
}

// Copies one field of `count` rows, from rows as they are in the file to rows of properties.
void convert(const PcdField& field, ConstColumn from, std::byte* to, std::size_t to_stride,
             std::size_t count) {
  if (is_packed_colour(field)) {
    const std::size_t channels = field.name == "rgba" ? 4 : 3;
    constexpr std::array kShift = {16, 8, 0, 24};  // red, green, blue, alpha
    for (std::size_t row = 0; row < count; ++row, from.data += from.stride) {
      const auto packed = load<std::uint32_t>(from.data);
      for (std::size_t i = 0; i < channels; ++i) {
        to[row * to_stride + i] = static_cast<std::byte>(packed >> kShift[i]);
      }
    }
    return;
  }
  const std::size_t to_size = size_of(scalar_of(field));
  for (std::size_t i = 0; i < field.count; ++i) {
    const std::byte* values = from.data + i * field.size;
    if (field.size == 8 && field.type != 'F') {
      with_pcd_type(field, [&](auto value) {
        for (std::size_t row = 0; row < count; ++row, values += from.stride)
          store(to + i * to_size + row * to_stride, static_cast<double>(load<decltype(value)>(values)));
      });
    } else {
      copy_column({.data = values, .stride = from.stride, .type = scalar_of(field)},
                  {.data = to + i * to_size, .stride = to_stride, .type = scalar_of(field)}, count);
    }
  }
}

std::size_t converted_bytes(const PcdField& field) {
  if (field.is_padding()) return 0;
  if (is_packed_colour(field)) return field.name == "rgba" ? 4 : 3;
  return size_of(scalar_of(field)) * field.count;
}

// Throws `Error` unless names differ and x, y and z are among them.
RowLayout pcd_layout(const InputFile& in, const PcdHeader& header) {
  std::vector<std::pair<std::string, Scalar>> properties;
  for (const PcdField& field : header.fields) {
    if (field.is_padding()) continue;
    if (is_packed_colour(field)) {
      for (const char* name : {"red", "green", "blue"}) properties.emplace_back(name, Scalar::kUint8);
      if (field.name == "rgba") properties.emplace_back("alpha", Scalar::kUint8);
    } else if (field.count == 1) {
      properties.emplace_back(name_of(field), scalar_of(field));
    } else {
      for (std::size_t i = 0; i < field.count; ++i) {
        properties.emplace_back(name_of(field) + '_' + std::to_string(i), scalar_of(field));
      }
    }
  }
  std::set<std::string_view> names;
  for (const auto& [name, type] : properties) {
    if (!names.insert(name).second) {
      in.fail_at_line(in.line(), "two fields have the name " + in_quotes(name) + "; names must differ");
    }
  }
  for (const char* name : {"x", "y", "z"}) {
    if (!names.contains(name)) {
      in.fail_at_line(in.line(),
                      "no field " + in_quotes(name) + " with one value a point; x, y and z are needed");
    }
  }
  return packed_layout(properties);
}

constexpr std::size_t kMostHeldColumns = 256;  // of a compressed file: each takes a stream

std::uint32_t read_size(InputFile& in) {
  std::array<std::byte, 4> bytes;
  in.read(bytes.data(), bytes.size());
  std::uint32_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) size |= std::to_integer<std::uint32_t>(bytes[i]) << 8 * i;
  return size;
}

bool is_product(std::uint64_t product, std::uint64_t a, std::uint64_t b) {
  return b == 0 ? product == 0 : product % b == 0 && product / b == a;
}

class PcdReader final : public ScanReader {
 public:
  explicit PcdReader(const std::filesystem::path& file)
      : in_(file),
        header_(read_pcd_header(in_)),
        layout_(pcd_layout(in_, header_)),
        left_(header_.rows),
        row_bytes_(header_.row_bytes()) {
    if (header_.encoding == PcdEncoding::kCompressed) {
      if (header_.rows > 0) open_block();
    } else {
      require_size();
    }
  }

  std::string format() const override { return std::string("PCD, ") + pcd_name(header_.encoding); }
  const RowLayout& layout() const override { return layout_; }
  std::vector<Eigen::Vector3d> no_return_places() const override {
    std::vector<Eigen::Vector3d> places{Eigen::Vector3d::Zero()};
    if (const auto scanner = header_.scanner()) places.push_back(*scanner);
    return places;
  }
  std::vector<ScannerPose> scanners() const override {
    const auto place = header_.scanner();
    return place ? std::vector{ScannerPose{.place = *place}} : std::vector<ScannerPose>{};
  }
  bool has_scanner_at_zero() const override { return !header_.scanner(); }
  std::optional<Pose> viewpoint() const override { return header_.viewpoint; }
  std::optional<std::uint64_t> expected_rows() const override { return header_.rows; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    assert(max_rows > 0);
    const std::size_t fitting = std::max<std::size_t>(1, kBatchBytes / row_bytes_);
    batch.count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, std::min(max_rows, fitting)));
    batch.bytes.resize(batch.count * layout_.stride);
    if (batch.count == 0) {
      require_end(in_, padding());
      return false;
    }
    read_raw(batch.count);
    convert_rows(batch);
    left_ -= batch.count;
    return true;
  }

 private:
  std::string_view padding() const;
  void require_size() const;
  [[noreturn]] void fail_too_short() const;
  void open_block();
  void start_columns();
  void read_raw(std::size_t count);
  void read_columns(std::byte* rows, std::size_t count);
  void read_text_row(std::byte* to);
  void convert_rows(RowBatch& batch) const;

  InputFile in_;
  PcdHeader header_;
  RowLayout layout_;
  std::uint64_t left_;             // rows not yet read
  std::size_t row_bytes_;          // padding included
  std::vector<std::byte> raw_;     // rows as the header describes them, in the machine's byte order
  std::uint64_t block_bytes_ = 0;  // compressed
  std::uint64_t unpacked_bytes_ = 0;
  bool has_padding_ = false;        // the block has columns of padding
  std::vector<LzfStream> columns_;  // of the fields but padding, once rows are read
  std::vector<std::byte> column_bytes_;
};

// The content of fields of padding is not defined.
void PcdReader::read_raw(std::size_t count) {
  raw_.resize(count * row_bytes_);
  if (header_.encoding == PcdEncoding::kAscii) {
    for (std::size_t row = 0; row < count; ++row) read_text_row(raw_.data() + row * row_bytes_);
  } else if (header_.encoding == PcdEncoding::kBinary) {
    in_.read(raw_.data(), raw_.size());
  } else {
    read_columns(raw_.data(), count);
  }
}

void PcdReader::convert_rows(RowBatch& batch) const {
  const auto stride = static_cast<std::ptrdiff_t>(row_bytes_);
  std::size_t from = 0, to = 0;
  for (const PcdField& field : header_.fields) {
    if (!field.is_padding()) {
      convert(field, {.data = raw_.data() + from, .stride = stride, .type = scalar_of(field)},
              batch.bytes.data() + to, layout_.stride, batch.count);
    }
    from += field.bytes();
    to += converted_bytes(field);
  }
}

// PCL reserves more than the rows or the compressed block need, up to a page, and leaves the rest zero.
std::string_view PcdReader::padding() const {
  using std::string_view_literals::operator""sv;
  if (header_.encoding == PcdEncoding::kAscii) return kBlanks;
  return header_.encoding == PcdEncoding::kBinary ? "\0 \t\r\n\v\f"sv : "\0"sv;
}

// The rows of an uncompressed file.
void PcdReader::require_size() const {
  const bool is_text = header_.encoding == PcdEncoding::kAscii;
  std::uint64_t least = row_bytes_, left = in_.remaining();
  if (is_text) {
    // A character and a blank for each value, but the last line may have no end.
    least = 0;
    for (const PcdField& field : header_.fields) least += 2 * field.count;
    ++left;
  }
  if (header_.rows > left / least) fail_too_short();
}

void PcdReader::fail_too_short() const {
  in_.fail_at_byte(in_.position() + in_.remaining(), "the file ends here, too early for the " +
                                                         std::to_string(header_.rows) +
                                                         " points of its header; it must be complete");
}

// A compressed file: two sizes, then the block.
void PcdReader::open_block() {
  const std::uint64_t place = in_.position();
  if (in_.remaining() < 8) fail_too_short();
  block_bytes_ = read_size(in_);
  unpacked_bytes_ = read_size(in_);
  if (block_bytes_ > in_.remaining()) fail_too_short();
  // PCL leaves padding out of the block; other writers may not.
  const std::uint64_t without = header_.row_bytes(false);
  has_padding_ = is_product(unpacked_bytes_, header_.rows, row_bytes_);
  if (!has_padding_ && !is_product(unpacked_bytes_, header_.rows, without)) {
    in_.fail_at_byte(place + 4, std::to_string(unpacked_bytes_) + " uncompressed bytes are not " +
                                    std::to_string(header_.rows) + " points of " + std::to_string(without) +
                                    " bytes; they must be equal");
  }
  if (unpacked_bytes_ > block_bytes_ * kLzfLargestRatio) {
    in_.fail_at_byte(place, std::to_string(block_bytes_) + " compressed bytes cannot come to the " +
                                std::to_string(unpacked_bytes_) + " declared; at most " +
                                std::to_string(kLzfLargestRatio) + " times as many are possible");
  }
  const auto columns = std::count_if(header_.fields.begin(), header_.fields.end(),
                                     [](const PcdField& field) { return !field.is_padding(); });
  if (static_cast<std::size_t>(columns) > kMostHeldColumns) {
    in_.fail_at_byte(place, std::to_string(columns) + " fields; compressed files may have " +
                                std::to_string(kMostHeldColumns));
  }
}

// Unpacks the whole block once, to find where each column begins.
void PcdReader::start_columns() {
  LzfStream stream(in_.file(), in_.position(), block_bytes_, unpacked_bytes_);
  for (const PcdField& field : header_.fields) {
    if (field.is_padding() && !has_padding_) continue;
    if (!field.is_padding()) columns_.push_back(stream.fork());
    stream.skip(header_.rows * field.bytes());
  }
  stream.require_end();
  in_.skip(block_bytes_);
}

void PcdReader::read_columns(std::byte* rows, std::size_t count) {
  if (columns_.empty()) start_columns();
  std::size_t offset = 0, column = 0;
  for (const PcdField& field : header_.fields) {
    if (!field.is_padding()) {
      column_bytes_.resize(count * field.bytes());
      columns_[column++].read(column_bytes_.data(), column_bytes_.size());
      for (std::size_t row = 0; row < count; ++row) {
        std::memcpy(rows + row * row_bytes_ + offset, column_bytes_.data() + row * field.bytes(),
                    field.bytes());
      }
    }
    offset += field.bytes();
  }
}

void PcdReader::read_text_row(std::byte* to) {
  std::string_view line, word;
  do {
    const auto next = in_.next_line();
    if (!next) {
      in_.fail_at_line(in_.line(), "the file ends here with fewer rows than the " +
                                       std::to_string(header_.rows) + " points of its header");
    }
    line = *next;
  } while (!LineWords(in_, line).next(word));
  constexpr const char* kNeeded = "every row must have a value for each field";
  LineWords words(in_, line);
  for (const PcdField& field : header_.fields) {
    for (std::size_t i = 0; i < field.count; ++i, to += field.size) {
      if (field.is_padding()) {
        if (!words.next(word)) words.fail(std::string("fewer values than needed; ") + kNeeded);
        continue;
      }
      with_pcd_type(field, [&](auto value) { store(to, words.number<decltype(value)>(kNeeded)); });
    }
  }
  words.require_end(kNeeded);
}

}  // namespace

bool looks_like_pcd(const FileStart& start) {
  if (start.first_bytes.starts_with("# .PCD")) return true;
  std::string_view rest = start.first_bytes;
  while (!rest.empty()) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    std::string_view word;
    if (!next_field(line, ' ', word) || word.starts_with('#')) continue;
    return word == "VERSION";
  }
  return false;
}

std::unique_ptr<ScanReader> open_pcd(const std::filesystem::path& file, const ReadOptions&) {
  return std::make_unique<PcdReader>(file);
}

}  // namespace lacuna::io
