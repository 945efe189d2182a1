// SPDX-License-Identifier: Apache-2.0
#include "io/read/e57/e57.hpp"
#include "io/read/files/number.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include <pugixml.hpp>

namespace lacuna::io {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{256} << 10;
constexpr std::size_t kBufferBytes = 4096;  // blocks are larger, and read past it

constexpr std::uint32_t kPolynomial = 0x82f63b78;  // 0x1edc6f41 with its bits reversed
constexpr std::size_t kBytesAtOnce = 8;

using Table = std::array<std::uint32_t, 256>;

// Table k has the checksum of each byte that k bytes of zero follow.
constexpr std::array<Table, kBytesAtOnce> kTables = [] {
  std::array<Table, kBytesAtOnce> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = rest >> 1 ^ ((rest & 1) != 0 ? kPolynomial : 0);
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < kBytesAtOnce; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = before >> 8 ^ tables[0][before & 255];
    }
  }
  return tables;
}();

// CRC-32C (polynomial 0x1EDC6F41, reflected, all bits inverted before and after): ASTM E2807-11; RFC 3720,
// 12.1. The result is the same on every machine. Eight bytes at once: Kounavis, Berry, A systematic approach
// to building high performance software-based CRC generators, ISCC 2005.
std::uint32_t page_checksum(std::span<const std::byte> data) {
  std::uint32_t checksum = ~std::uint32_t{0};
  for (; data.size() >= kBytesAtOnce; data = data.subspan(kBytesAtOnce)) {
    const std::uint64_t word = load<std::uint64_t>(data.data()) ^ checksum;
    checksum = 0;
    for (std::size_t i = 0; i < kBytesAtOnce; ++i)
      checksum ^= kTables[kBytesAtOnce - 1 - i][word >> 8 * i & 255];
  }
  for (const std::byte byte : data) {
    checksum = checksum >> 8 ^ kTables[0][(checksum ^ std::to_integer<std::uint32_t>(byte)) & 255];
  }
  return ~checksum;
}

std::uint32_t stored_checksum(const std::byte* from) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < PagedFile::kChecksumBytes; ++i) {
    value = value << 8 | std::to_integer<std::uint32_t>(from[i]);
  }
  return value;
}

}  // namespace

PagedFile::PagedFile(const std::filesystem::path& file, std::size_t page_bytes)
    : in_(std::make_unique<InputFile>(file, kBufferBytes)),
      page_bytes_(page_bytes),
      data_bytes_(page_bytes - kChecksumBytes),
      pages_(in_->remaining() / page_bytes),
      size_(pages_ * data_bytes_) {
  assert(page_bytes > kChecksumBytes);
  if (in_->remaining() % page_bytes != 0) {
    in_->fail_at_byte(pages_ * page_bytes, "the file ends here, within a page of " +
                                               std::to_string(page_bytes) + " bytes; it must be complete");
  }
}

void PagedFile::seek(std::uint64_t physical, const std::string& what) {
  const std::uint64_t page = physical / page_bytes_, offset = physical % page_bytes_;
  if (page >= pages_) {
    in_->fail_at_byte(pages_ * page_bytes_, "the file ends here, but " + what + " should begin at byte " +
                                                std::to_string(physical) + "; it must be complete");
  }
  if (offset >= data_bytes_) {
    in_->fail_at_byte(physical, what + " should begin here, within a checksum; its offset must hold");
  }
  position_ = page * data_bytes_ + offset;
}

void PagedFile::skip(std::uint64_t count) {
  assert(count <= size_ - position_);
  position_ += count;
}

void PagedFile::read(std::byte* to, std::size_t count) {
  if (count > size_ - position_) fail(size_, "the file ends here, too early; it must be complete");
  while (count > 0) {
    const std::byte* const page = checked_page(position_ / data_bytes_);
    const std::size_t offset = position_ % data_bytes_;
    const std::size_t ready = std::min(count, data_bytes_ - offset);
    std::memcpy(to, page + offset, ready);
    position_ += ready;
    to += ready;
    count -= ready;
  }
}

void PagedFile::fail(std::uint64_t logical, const std::string& reason) const {
  fail_physical(logical / data_bytes_ * page_bytes_ + logical % data_bytes_, reason);
}

void PagedFile::fail_physical(std::uint64_t physical, const std::string& reason) const {
  in_->fail_at_byte(physical, reason);
}

const std::byte* PagedFile::checked_page(std::uint64_t page) {
  if (page < block_begin_ || page >= block_end_) load(page);
  const std::byte* const bytes = block_.data() + (page - block_begin_) * page_bytes_;
  if (checked_pages_ == page + 1) return bytes;
  if (page_checksum(std::span(bytes, data_bytes_)) != stored_checksum(bytes + data_bytes_)) {
    in_->fail_at_byte(page * page_bytes_, "the checksum of the page of " + std::to_string(page_bytes_) +
                                              " bytes from here on is wrong; the file is damaged");
  }
  checked_pages_ = page + 1;
  return bytes;
}

void PagedFile::load(std::uint64_t page) {
  const std::uint64_t begin = page * page_bytes_;
  if (begin < in_->position()) in_ = std::make_unique<InputFile>(in_->file(), kBufferBytes);
  in_->skip(begin - in_->position());
  const std::uint64_t count =
      std::min<std::uint64_t>(std::max<std::size_t>(1, kBlockBytes / page_bytes_), pages_ - page);
  block_.resize(count * page_bytes_);
  block_begin_ = block_end_ = page;
  checked_pages_ = 0;
  in_->read(block_.data(), block_.size());
  block_end_ = page + count;
}

namespace {

// A packet of 64 KiB begins with 6 bytes, and 2 for each field.
constexpr std::size_t kMostFields = 32765;

// The XML section, and where it is in the file.
struct Xml {
  const PagedFile& pages;
  std::uint64_t begin;  // logical

  [[noreturn]] void fail(pugi::xml_node node, const std::string& reason) const {
    const std::uint64_t offset =
        node.offset_debug() > 0 ? static_cast<std::uint64_t>(node.offset_debug()) : 0;
    pages.fail(begin + offset, reason);
  }
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Returns the text of all parts: writers divide a string that holds "]]>".
std::string text_of(pugi::xml_node node) {
  std::string text;
  for (const pugi::xml_node part : node.children()) text += part.value();
  return text;
}

// Returns an attribute as a number; `missing` if there is none.
template <class T>
T number(const Xml& xml, pugi::xml_node node, const char* name, std::optional<T> missing) {
  const pugi::xml_attribute attribute = node.attribute(name);
  if (!attribute && missing) return *missing;
  T value;
  if (!parse_number(trimmed(attribute.value()), value)) {
    xml.fail(node, std::string("the ") + name + " of " + in_quotes(node.name()) + " is " +
                       (attribute ? in_quotes(attribute.value()) : "missing") + "; it must be " +
                       describe_number<T>());
  }
  return value;
}

// Returns the number that an element holds, 0 if it is empty.
double element_value(const Xml& xml, pugi::xml_node node) {
  const std::string_view type = node.attribute("type").value();
  const std::string text = text_of(node);
  const std::string_view digits = trimmed(text);
  double value = 0;
  const bool is_number = (digits.empty() || parse_number(digits, value)) && std::isfinite(value);
  if ((type != "Float" && type != "Integer") || !is_number) {
    xml.fail(node, in_quotes(node.name()) + " of a pose must be a Float with a finite number");
  }
  return value;
}

E57Field read_field(const Xml& xml, pugi::xml_node node) {
  const std::string_view type = node.attribute("type").value();
  E57Field field{.name = node.name()};
  if (type == "Float") {
    const pugi::xml_attribute precision = node.attribute("precision");
    const std::string_view is = precision ? precision.value() : "double";
    if (is != "single" && is != "double") {
      xml.fail(node, "field " + in_quotes(node.name()) + " has the precision " + in_quotes(is) +
                         "; allowed are single and double");
    }
    field.type = is == "single" ? E57Field::Type::kFloat32 : E57Field::Type::kFloat64;
    field.bits = is == "single" ? 32 : 64;
    return field;
  }
  if (type != "Integer" && type != "ScaledInteger") {
    xml.fail(node, "field " + in_quotes(node.name()) + " of the points has the type " + in_quotes(type) +
                       "; read are Float, Integer and ScaledInteger");
  }
  using Limits = std::numeric_limits<std::int64_t>;
  field.type = type == "Integer" ? E57Field::Type::kInteger : E57Field::Type::kScaledInteger;
  field.minimum = number<std::int64_t>(xml, node, "minimum", Limits::min());
  const auto maximum = number<std::int64_t>(xml, node, "maximum", Limits::max());
  if (maximum < field.minimum) {
    xml.fail(node, "field " + in_quotes(node.name()) + " has a maximum below its minimum");
  }
  field.bits = static_cast<unsigned>(
      std::bit_width(static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(field.minimum)));
  if (field.type == E57Field::Type::kScaledInteger) {
    field.scale = number<double>(xml, node, "scale", 1.0);
    field.offset = number<double>(xml, node, "offset", 0.0);
    if (!std::isfinite(field.scale) || field.scale == 0 || !std::isfinite(field.offset)) {
      xml.fail(node, "field " + in_quotes(node.name()) +
                         " has a scale that is 0, or a scale or offset that is not finite");
    }
  }
  return field;
}

// Fields are packed bit by bit unless a codec says otherwise.
void check_codecs(const Xml& xml, pugi::xml_node points) {
  for (const pugi::xml_node codec : points.child("codecs").children()) {
    for (const pugi::xml_node part : codec.children()) {
      const std::string_view name = part.name();
      if (name != "inputs" && name != "bitPackCodec") {
        xml.fail(part, "the points are packed by " + in_quotes(name) + "; only 'bitPackCodec' is read");
      }
    }
  }
}

void read_pose(const Xml& xml, pugi::xml_node node, E57Scan& scan) {
  constexpr double kZero = 1e-6;  // a rounded 0; other lengths than 1 are of writers that scale quaternions
  Pose& pose = scan.pose;
  const auto value = [&](pugi::xml_node of, const char* name) {
    const pugi::xml_node child = of.child(name);
    if (!child) xml.fail(of, in_quotes(of.name()) + " has no " + in_quotes(name));
    return element_value(xml, child);
  };
  if (const pugi::xml_node translation = node.child("translation")) {
    pose.translation() =
        Eigen::Vector3d(value(translation, "x"), value(translation, "y"), value(translation, "z"));
  }
  if (const pugi::xml_node rotation = node.child("rotation")) {
    const Eigen::Quaterniond turn(value(rotation, "w"), value(rotation, "x"), value(rotation, "y"),
                                  value(rotation, "z"));
    if (!std::isfinite(turn.norm())) {
      xml.fail(rotation, "the rotation of a pose has the length " + std::to_string(turn.norm()) +
                             "; a quaternion must have the length 1");
    }
    scan.has_zero_rotation = turn.norm() < kZero;
    if (!scan.has_zero_rotation) pose.linear() = turn.normalized().toRotationMatrix();
  }
}

// Scans with a section in common, and columns of one value, take no bytes for each value.
constexpr std::uint64_t kMostValuesInAByte = 64;

// Adds the values of a scan to the values of the scans before.
void count_values(const Xml& xml, pugi::xml_node points, const E57Scan& scan, std::uint64_t& values) {
  values += scan.records * scan.fields.size();  // below 2^63: of at most 2^15 fields and a record in a byte
  if (values / kMostValuesInAByte <= xml.pages.size()) return;
  xml.fail(points, "the scans up to here have " + std::to_string(values) + " values, in a file of " +
                       std::to_string(xml.pages.size()) + " bytes; at most " +
                       std::to_string(kMostValuesInAByte) + " in a byte are read");
}

// `values` counts the scans before, and then this one, too.
E57Scan read_scan(const Xml& xml, pugi::xml_node node, std::uint64_t& values) {
  E57Scan scan;
  const pugi::xml_node points = node.child("points");
  if (!points) return scan;
  scan.records = number<std::uint64_t>(xml, points, "recordCount", std::nullopt);
  const bool is_empty = scan.records == 0;
  const auto missing = is_empty ? std::optional<std::uint64_t>(0) : std::nullopt;
  scan.points_at = number<std::uint64_t>(xml, points, "fileOffset", missing);
  if (is_empty) return scan;
  check_codecs(xml, points);
  std::uint64_t bits = 0;
  for (const pugi::xml_node field : points.child("prototype").children()) {
    if (scan.fields.size() == kMostFields) {
      xml.fail(field, "points of more than " + std::to_string(kMostFields) + " fields; a packet has no more");
    }
    scan.fields.push_back(read_field(xml, field));
    bits += scan.fields.back().bits;
  }
  // Positions of less than a byte have fewer than 256 places, so more points would be copies that cost
  // memory.
  const std::uint64_t most = xml.pages.size() * 8 / std::max<std::uint64_t>(bits, 8);
  if (scan.records > most) {
    xml.fail(points, std::to_string(scan.records) + " points of " + std::to_string(bits) +
                         " bits; the file holds at most " + std::to_string(most));
  }
  count_values(xml, points, scan, values);
  scan.has_pose = !node.child("pose").empty();
  read_pose(xml, node.child("pose"), scan);
  return scan;
}

}  // namespace

void read_e57_xml(PagedFile& pages, std::size_t bytes, E57Header& header) {
  const Xml xml{.pages = pages, .begin = pages.position()};
  std::string text(bytes, '\0');
  pages.read(reinterpret_cast<std::byte*>(text.data()), text.size());
  text.erase(text.find_last_not_of('\0') + 1);  // padding
  pugi::xml_document document;
  // Entities of a document type are not expanded: pugixml passes over it.
  const pugi::xml_parse_result result =
      document.load_buffer_inplace(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) {
    pages.fail(xml.begin + static_cast<std::uint64_t>(result.offset),
               std::string("the XML section cannot be read: ") + result.description());
  }
  const pugi::xml_node root = document.child("e57Root"), data = root.child("data3D");
  if (!data)
    xml.fail(root, "the XML section has no scans; an element e57Root with an element data3D is needed");
  header.coordinate_metadata = text_of(root.child("coordinateMetadata"));
  std::uint64_t values = 0;
  for (const pugi::xml_node scan : data.children()) header.scans.push_back(read_scan(xml, scan, values));
}

namespace {

// The first page holds the whole header. 1 MiB is a thousand times the size that programs write.
constexpr std::uint64_t kLeastPage = 64, kLargestPage = std::uint64_t{1} << 20;
constexpr std::uint64_t kLongestXml = std::uint64_t{16} << 20;

// 48 bytes, in this order: signature, major and minor version, length of the file, offset and length of the
// XML section, size of a page.
using Bytes = std::array<std::byte, 48>;
constexpr std::size_t kMajor = 8, kMinor = 12, kFileLength = 16, kXmlOffset = 24, kXmlLength = 32,
                      kPageSize = 40;

// Reads the bytes as they are in the file, since the size of a page is among them.
std::size_t read_page_bytes(const std::filesystem::path& file) {
  InputFile in(file, 4096);
  const std::uint64_t size = in.remaining();
  if (size < Bytes{}.size()) in.fail_at_byte(size, "the file ends here, within its header of 48 bytes");
  Bytes head;
  in.read(head.data(), head.size());
  const auto major = load<std::uint32_t>(&head[kMajor]), minor = load<std::uint32_t>(&head[kMinor]);
  if (major != 1 || minor != 0) {
    in.fail_at_byte(kMajor,
                    "E57 " + std::to_string(major) + "." + std::to_string(minor) + "; version 1.0 is read");
  }
  const auto page = load<std::uint64_t>(&head[kPageSize]);
  if (!std::has_single_bit(page) || page < kLeastPage || page > kLargestPage) {
    in.fail_at_byte(kPageSize, "pages of " + std::to_string(page) +
                                   " bytes; allowed are powers of two from 64 to 1048576");
  }
  const auto length = load<std::uint64_t>(&head[kFileLength]);
  if (size < length) {
    in.fail_at_byte(size, "the file ends here, but its header states " + std::to_string(length) +
                              " bytes; it must be complete");
  }
  if (size > length) {
    in.fail_at_byte(kFileLength, "the header states " + std::to_string(length) + " bytes, but the file has " +
                                     std::to_string(size) + "; they must be equal");
  }
  return static_cast<std::size_t>(page);
}

}  // namespace

E57Header read_e57_header(const std::filesystem::path& file) {
  E57Header header;
  header.page_bytes = read_page_bytes(file);
  PagedFile pages(file, header.page_bytes);
  Bytes head;
  pages.read(head.data(), head.size());  // again, with its checksum
  const auto xml_length = load<std::uint64_t>(&head[kXmlLength]);
  pages.seek(load<std::uint64_t>(&head[kXmlOffset]), "the XML section");
  if (xml_length > pages.size() - pages.position()) {
    pages.fail(kXmlLength, "an XML section of " + std::to_string(xml_length) +
                               " bytes, more than the file has behind its beginning");
  }
  if (xml_length > kLongestXml) {
    pages.fail(kXmlLength, "an XML section of " + std::to_string(xml_length) + " bytes; up to " +
                               std::to_string(kLongestXml) + " are read");
  }
  read_e57_xml(pages, static_cast<std::size_t>(xml_length), header);
  return header;
}

}  // namespace lacuna::io
