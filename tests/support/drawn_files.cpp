// SPDX-License-Identifier: Apache-2.0
#include "tests/support/drawn_files.hpp"

namespace lacuna::test {
namespace {

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

template <class T>
std::string raw_all(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

// 17 digits are enough for any double.
std::string digits(double value) {
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

std::string limits(std::int64_t minimum, std::int64_t maximum) {
  return " minimum=\"" + std::to_string(minimum) + "\" maximum=\"" + std::to_string(maximum) + "\"";
}

std::string packed(std::int64_t minimum, std::int64_t maximum, const std::vector<std::int64_t>& values) {
  const std::uint64_t range = static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(minimum);
  const auto bits = static_cast<std::size_t>(std::bit_width(range));
  std::string bytes((values.size() * bits + 7) / 8, '\0');
  std::size_t at = 0;
  for (const std::int64_t value : values) {
    const std::uint64_t stored = static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(minimum);
    for (std::size_t bit = 0; bit < bits; ++bit, ++at)
      if (stored >> bit & 1) bytes[at / 8] = static_cast<char>(bytes[at / 8] | 1 << at % 8);
  }
  return bytes;
}

// The part of a field in packet k of `packets`: cut anywhere, not between values.
std::string part_of(const E57Values& field, std::size_t rank, std::size_t k, std::size_t packets) {
  const auto cut = [&](std::size_t i) {
    if (i == 0) return std::size_t{0};
    if (i == packets) return field.bytes.size();
    return std::min(field.bytes.size(), field.bytes.size() / packets * i + rank * 3 % 7);
  };
  return field.bytes.substr(cut(k), cut(k + 1) - cut(k));
}

std::string packet_head(std::uint8_t type, std::size_t bytes) {
  return raw(type) + raw(std::uint8_t{0}) + raw(static_cast<std::uint16_t>(bytes - 1));
}

std::string data_packet(const E57TestScan& scan, std::size_t k) {
  std::string lengths, parts;
  for (std::size_t i = 0; i < scan.fields.size(); ++i) {
    const std::string part = part_of(scan.fields[i], i, k, scan.packets);
    lengths += raw(static_cast<std::uint16_t>(part.size()));
    parts += part;
  }
  std::string body = raw(static_cast<std::uint16_t>(scan.fields.size())) + lengths + parts;
  body.resize((body.size() + 3) / 4 * 4);
  return packet_head(1, 4 + body.size()) + body;
}

std::size_t physical(std::size_t logical, std::size_t page_bytes) {
  return logical / (page_bytes - 4) * page_bytes + logical % (page_bytes - 4);
}

// The section of a scan's points, from a logical offset on.
std::string section(const E57TestScan& scan, std::size_t begin, const E57FileForm& form) {
  std::string packets;
  if (form.has_other_packets) packets += packet_head(0, 16) + std::string(12, '\0');
  const std::size_t data = begin + 32 + packets.size();
  for (std::size_t k = 0; k < scan.packets; ++k) {
    if (form.has_other_packets && k > 0 && k + 1 == scan.packets)
      packets += packet_head(2, 8) + std::string(4, '\0');
    packets += data_packet(scan, k);
  }
  return raw(std::uint64_t{1}) + raw(std::uint64_t{32 + packets.size()}) +
         raw(std::uint64_t{physical(data, form.page_bytes)}) + raw(std::uint64_t{0}) + packets;
}

std::string scan_xml(const E57TestScan& scan, std::size_t offset) {
  std::string xml =
      "<vectorChild type=\"Structure\">\n<guid type=\"String\"><![CDATA[{1}]]></guid>\n" + scan.pose;
  const std::size_t count = scan.fields.empty() ? 0 : scan.fields.front().count;
  xml += "<points type=\"CompressedVector\" fileOffset=\"" + std::to_string(offset) + "\" recordCount=\"" +
         std::to_string(count) + "\">\n<prototype type=\"Structure\">\n";
  for (const E57Values& field : scan.fields) xml += "<" + field.name + " " + field.attributes + "/>\n";
  return xml + "</prototype>\n" + scan.codecs + "</points>\n</vectorChild>\n";
}

// Bit by bit, for each value of a byte.
std::array<std::uint32_t, 256> checksum_table() {
  std::array<std::uint32_t, 256> table;
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = rest & 1 ? rest >> 1 ^ 0x82f63b78u : rest >> 1;
    table[byte] = rest;
  }
  return table;
}

}  // namespace

E57Values e57_floats(const std::string& name, const std::vector<float>& values) {
  return {name, "type=\"Float\" precision=\"single\"", raw_all(values), values.size()};
}

E57Values e57_doubles(const std::string& name, const std::vector<double>& values) {
  return {name, "type=\"Float\"", raw_all(values), values.size()};
}

std::vector<E57Values> e57_position(const std::vector<double>& x, const std::vector<double>& y,
                                    const std::vector<double>& z) {
  return {e57_doubles("cartesianX", x), e57_doubles("cartesianY", y), e57_doubles("cartesianZ", z)};
}

E57Values e57_integers(const std::string& name, std::int64_t minimum, std::int64_t maximum,
                       const std::vector<std::int64_t>& values) {
  return {name, "type=\"Integer\"" + limits(minimum, maximum), packed(minimum, maximum, values),
          values.size()};
}

E57Values e57_scaled(const std::string& name, std::int64_t minimum, std::int64_t maximum, double scale,
                     double offset, const std::vector<std::int64_t>& values) {
  return {name,
          "type=\"ScaledInteger\"" + limits(minimum, maximum) + " scale=\"" + digits(scale) + "\" offset=\"" +
              digits(offset) + "\"",
          packed(minimum, maximum, values), values.size()};
}

std::string e57_pose(const std::vector<double>& quaternion, const std::vector<double>& translation) {
  const auto structure = [](const std::string& name, const std::string& parts,
                            const std::vector<double>& values) {
    std::string xml = "<" + name + " type=\"Structure\">";
    for (std::size_t i = 0; i < values.size(); ++i)
      xml += std::string("<") + parts[i] + " type=\"Float\">" + digits(values[i]) + "</" + parts[i] + ">";
    return xml + "</" + name + ">";
  };
  return "<pose type=\"Structure\">" + structure("rotation", "wxyz", quaternion) +
         structure("translation", "xyz", translation) + "</pose>\n";
}

std::string encode_e57(const std::vector<E57TestScan>& scans, const E57FileForm& form) {
  std::string logical(48, '\0');
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<e57Root type=\"Structure\" xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\""
      " xmlns:nor=\"http://www.libe57.org/E57_NOR_surface_normals.txt\">\n"
      "<formatName type=\"String\"><![CDATA[ASTM E57 3D Imaging Data File]]></formatName>\n"
      "<guid type=\"String\"><![CDATA[{00000000-0000-0000-0000-000000000000}]]></guid>\n"
      "<versionMajor type=\"Integer\">1</versionMajor>\n<versionMinor type=\"Integer\">0</versionMinor>\n" +
      form.root + "<data3D type=\"Vector\" allowHeterogeneousChildren=\"1\">\n";
  for (const E57TestScan& scan : scans) {
    xml += scan_xml(scan, physical(logical.size(), form.page_bytes));
    logical += section(scan, logical.size(), form);
  }
  xml += "</data3D>\n<images2D type=\"Vector\" allowHeterogeneousChildren=\"1\"/>\n</e57Root>\n";
  const std::size_t xml_at = logical.size(), data_bytes = form.page_bytes - 4;
  logical += xml;
  const std::size_t pages = (logical.size() + data_bytes - 1) / data_bytes;
  logical.resize(pages * data_bytes);
  logical.replace(0, 48,
                  "ASTM-E57" + raw(std::uint32_t{1}) + raw(std::uint32_t{0}) +
                      raw(std::uint64_t{pages * form.page_bytes}) +
                      raw(std::uint64_t{physical(xml_at, form.page_bytes)}) + raw(std::uint64_t{xml.size()}) +
                      raw(std::uint64_t{form.page_bytes}));
  std::string file;
  for (std::size_t page = 0; page < pages; ++page)
    file += logical.substr(page * data_bytes, data_bytes) + std::string(4, '\0');
  repair_e57_checksums(file, form.page_bytes);
  return file;
}

void repair_e57_checksums(std::string& file, std::size_t page_bytes) {
  static const std::array<std::uint32_t, 256> kTable = checksum_table();
  for (std::size_t end = page_bytes; end <= file.size(); end += page_bytes) {
    std::uint32_t checksum = ~0u;
    for (std::size_t i = end - page_bytes; i < end - 4; ++i)
      checksum = checksum >> 8 ^ kTable[(checksum ^ static_cast<unsigned char>(file[i])) & 255];
    checksum = ~checksum;
    for (std::size_t i = 0; i < 4; ++i) file[end - 4 + i] = static_cast<char>(checksum >> (24 - 8 * i));
  }
}

}  // namespace lacuna::test
