// SPDX-License-Identifier: Apache-2.0
#include "io/read/e57/e57_header.hpp"

#include "io/read/files/little_endian.hpp"

#include <bit>

namespace lacuna::io {
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
