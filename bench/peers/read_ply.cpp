// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/read_ply.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna::peers {
namespace {

class MappedFile {
 public:
  explicit MappedFile(const char* file) : descriptor_(::open(file, O_RDONLY)) {
    struct stat status {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) throw std::runtime_error("cannot be opened");
    size_ = static_cast<std::size_t>(status.st_size);
    data_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE | MAP_POPULATE, descriptor_, 0);
    if (data_ == MAP_FAILED) throw std::runtime_error("cannot be read");
  }
  ~MappedFile() {
    if (data_ != MAP_FAILED) ::munmap(data_, size_);
    ::close(descriptor_);
  }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view text() const { return {static_cast<const char*>(data_), size_}; }

 private:
  int descriptor_;
  std::size_t size_ = 0;
  void* data_ = MAP_FAILED;
};

struct Property {
  std::string type, name;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  bool ascii = false;
  std::vector<Element> before;  // the vertices
  Element vertex;
  std::size_t size = 0;  // bytes
};

Header read_header(std::string_view text) {
  constexpr std::string_view kEnd = "end_header";
  const std::size_t end = text.find(kEnd);
  if (end == text.npos) throw std::runtime_error("no PLY header");
  Header header;
  header.size = text.find('\n', end) + 1;
  std::vector<Element> elements;
  std::istringstream lines{std::string(text.substr(0, end))};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "format") {
      words >> word;
      header.ascii = word == "ascii";
      if (!header.ascii && word != "binary_little_endian") throw std::runtime_error("format not known");
    } else if (word == "element") {
      Element& element = elements.emplace_back();
      words >> element.name >> element.count;
    } else if (word == "property" && !elements.empty()) {
      Property& property = elements.back().properties.emplace_back();
      words >> property.type >> property.name;
    }
  }
  for (const Element& element : elements) {
    if (element.name == "vertex") {
      header.vertex = element;
      return header;
    }
    header.before.push_back(element);
  }
  throw std::runtime_error("no vertices");
}

std::size_t size_of(const std::string& type) {
  static const std::map<std::string, std::size_t> kSizes{
      {"char", 1},  {"uchar", 1},  {"int8", 1},    {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2}, {"int", 4},     {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"double", 8}, {"float32", 4}, {"float64", 8}};
  const auto found = kSizes.find(type);
  if (found == kSizes.end()) throw std::runtime_error("vertices or what precedes them have a list");
  return found->second;
}

std::size_t stride(const Element& element) {
  std::size_t bytes = 0;
  for (const Property& property : element.properties) bytes += size_of(property.type);
  return bytes;
}

// Places of x, y and z among the properties.
std::array<std::size_t, 3> find_position(const Element& vertex) {
  std::array<std::size_t, 3> found{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    while (found[axis] < vertex.properties.size() && vertex.properties[found[axis]].name[0] != "xyz"[axis]) {
      ++found[axis];
    }
    if (found[axis] == vertex.properties.size()) throw std::runtime_error("no x, y and z");
  }
  return found;
}

void add_finite(const std::array<float, 3>& p, std::vector<float>& coordinates) {
  if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) {
    coordinates.insert(coordinates.end(), p.begin(), p.end());
  }
}

template <class Real>
void read_binary(std::string_view rows, std::size_t row_size, const std::array<std::size_t, 3>& offsets,
                 std::vector<float>& coordinates) {
  for (const char* row = rows.data(); row != rows.data() + rows.size(); row += row_size) {
    std::array<float, 3> p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Real coordinate;
      std::memcpy(&coordinate, row + offsets[axis], sizeof coordinate);
      p[axis] = static_cast<float>(coordinate);
    }
    add_finite(p, coordinates);
  }
}

void read_binary(std::string_view body, const Header& header, std::vector<float>& coordinates) {
  std::size_t begin = 0;
  for (const Element& element : header.before) begin += element.count * stride(element);
  const std::size_t row_size = stride(header.vertex), size = header.vertex.count * row_size;
  if (begin + size > body.size()) throw std::runtime_error("too short");

  const std::array<std::size_t, 3> position = find_position(header.vertex);
  std::array<std::size_t, 3> offsets{};
  const std::string& type = header.vertex.properties[position[0]].type;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (header.vertex.properties[position[axis]].type != type)
      throw std::runtime_error("x, y and z differ in type");
    for (std::size_t i = 0; i < position[axis]; ++i)
      offsets[axis] += size_of(header.vertex.properties[i].type);
  }
  const std::string_view rows = body.substr(begin, size);
  if (type == "double" || type == "float64") {
    read_binary<double>(rows, row_size, offsets, coordinates);
  } else if (type == "float" || type == "float32") {
    read_binary<float>(rows, row_size, offsets, coordinates);
  } else {
    throw std::runtime_error("coordinates are neither float nor double");
  }
}

void read_ascii(std::string_view body, const Header& header, std::vector<float>& coordinates) {
  const std::array<std::size_t, 3> position = find_position(header.vertex);
  const char *at = body.data(), *const end = body.data() + body.size();
  const auto next = [&] {
    while (at != end && (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t')) ++at;
    float number = 0;
    const std::from_chars_result result = std::from_chars(at, end, number);
    if (result.ec == std::errc::invalid_argument) throw std::runtime_error("not a number, or too short");
    at = result.ptr;
    return number;
  };
  for (const Element& element : header.before) {
    for (std::uint64_t i = 0; i < element.count * element.properties.size(); ++i) next();
  }
  std::vector<float> row(header.vertex.properties.size());
  for (std::uint64_t i = 0; i < header.vertex.count; ++i) {
    for (float& number : row) number = next();
    add_finite({row[position[0]], row[position[1]], row[position[2]]}, coordinates);
  }
}

}  // namespace

std::vector<float> read_ply(const char* file) {
  try {
    const MappedFile mapped(file);
    const Header header = read_header(mapped.text());
    std::vector<float> coordinates;
    coordinates.reserve(3 * header.vertex.count);
    const std::string_view body = mapped.text().substr(header.size);
    if (header.ascii) {
      read_ascii(body, header, coordinates);
    } else {
      read_binary(body, header, coordinates);
    }
    return coordinates;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(std::string(file) + ": " + error.what());
  }
}

}  // namespace lacuna::peers
