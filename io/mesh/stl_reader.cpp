// SPDX-License-Identifier: Apache-2.0
#include "io/mesh/stl_reader.hpp"

#include "io/files/line_words.hpp"
#include "io/files/property_name.hpp"
#include "io/rows/scalar.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace lacuna::io {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kTriangleBytes = 50;  // a normal, three vertices, two bytes for any use
constexpr std::size_t kNormalBytes = 12;
constexpr std::size_t kVertexBytes = 12;

// Returns the number as a binary file has it; nothing if there is no whole header.
std::optional<std::uint64_t> count_triangles(const FileStart& start) {
  if (start.first_bytes.size() < kHeaderBytes) return std::nullopt;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    count |= std::uint64_t{static_cast<unsigned char>(start.first_bytes[kHeaderBytes - 4 + i])} << 8 * i;
  }
  return count;
}

bool is_binary(const FileStart& start) {
  const auto triangles = count_triangles(start);
  return triangles && start.size == kHeaderBytes + kTriangleBytes * *triangles;
}

// Returns the keyword of a line, in lower case as most writers have it.
std::string first_word(LineWords& words) {
  std::string_view word;
  words.next(word);
  return lower_case(word);
}

RowLayout layout_of(Scalar type) {
  const std::array<std::pair<std::string, Scalar>, 3> properties = {{{"x", type}, {"y", type}, {"z", type}}};
  return packed_layout(properties);
}

class BinaryStl final : public ScanReader {
 public:
  BinaryStl(const std::filesystem::path& file, std::uint64_t triangles)
      : in_(file), layout_(layout_of(Scalar::kFloat32)), triangles_(triangles), left_(triangles * 3) {
    in_.skip(kHeaderBytes);
  }

  std::string format() const override { return "STL, binary"; }
  const RowLayout& layout() const override { return layout_; }
  std::optional<std::uint64_t> expected_rows() const override { return triangles_ * 3; }
  std::vector<ReaderNote> notes() const override { return {note_of_faces(triangles_)}; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    return fill_batch(batch, max_rows, kVertexBytes, [&](std::byte* to) {
      if (left_ == 0) return false;
      if (left_ % 3 == 0) in_.skip(kNormalBytes);
      in_.read(to, kVertexBytes);
      if (left_ % 3 == 1) in_.skip(kTriangleBytes - kNormalBytes - 3 * kVertexBytes);
      --left_;
      return true;
    });
  }

 private:
  InputFile in_;
  RowLayout layout_;
  std::uint64_t triangles_;
  std::uint64_t left_;  // vertices not yet read
};

class AsciiStl final : public ScanReader {
 public:
  explicit AsciiStl(const std::filesystem::path& file) : in_(file), layout_(layout_of(Scalar::kFloat64)) {}

  std::string format() const override { return "STL, ascii"; }
  const RowLayout& layout() const override { return layout_; }
  std::optional<std::uint64_t> expected_rows() const override { return std::nullopt; }

  // Reads the whole file.
  std::vector<ReaderNote> notes() const override {
    InputFile in(in_.file());
    std::uint64_t facets = 0;
    while (const auto line = in.next_line()) {
      LineWords words(in, *line);
      facets += first_word(words) == "facet" ? 1 : 0;
    }
    return {note_of_faces(facets)};
  }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    return fill_batch(batch, max_rows, layout_.stride, [&](std::byte* to) {
      while (const auto line = in_.next_line()) {
        if (read_line(*line, to)) return true;
      }
      if (within_ != Within::kOutside)
        in_.fail_at_line(in_.line(), "the file ends here within a solid; 'endsolid' must follow");
      return false;
    });
  }

 private:
  enum class Within : std::uint8_t { kOutside, kSolid, kFacet, kLoop, kClosed };

  // Whether the line has a vertex.
  bool read_line(std::string_view line, std::byte* to) {
    LineWords words(in_, line);
    const std::string keyword = first_word(words);
    if (keyword.empty()) return false;
    if (keyword == "vertex") {
      if (within_ != Within::kLoop || corners_ == 3) words.fail("a vertex outside of a loop of three");
      constexpr const char* kNeeded = "'vertex x y z' is allowed";
      for (int i = 0; i < 3; ++i, to += sizeof(double)) {
        const auto value = words.number<double>(kNeeded);
        std::memcpy(to, &value, sizeof value);
      }
      words.require_end(kNeeded);
      ++corners_;
      return true;
    }
    if (keyword == "endloop" && corners_ != 3) {
      words.fail(std::to_string(corners_) + " vertices of a facet; three are needed");
    }
    struct Step {
      const char* keyword;
      Within from, to;
    };
    constexpr std::array<Step, 6> kSteps = {{{"solid", Within::kOutside, Within::kSolid},
                                             {"facet", Within::kSolid, Within::kFacet},
                                             {"outer", Within::kFacet, Within::kLoop},
                                             {"endloop", Within::kLoop, Within::kClosed},
                                             {"endfacet", Within::kClosed, Within::kSolid},
                                             {"endsolid", Within::kSolid, Within::kOutside}}};
    for (const Step& step : kSteps) {
      if (within_ != step.from || keyword != step.keyword) continue;
      within_ = step.to;
      corners_ = 0;
      return false;
    }
    words.fail(in_quotes(keyword) + " is not expected here; allowed are " + allowed_here());
  }

  std::string allowed_here() const {
    switch (within_) {
      case Within::kOutside:
        return "'solid' and the end of the file";
      case Within::kSolid:
        return "'facet' and 'endsolid'";
      case Within::kFacet:
        return "'outer loop'";
      case Within::kLoop:
        return "'vertex' and 'endloop'";
      case Within::kClosed:
        break;
    }
    return "'endfacet'";
  }

  InputFile in_;
  RowLayout layout_;
  Within within_ = Within::kOutside;
  int corners_ = 0;  // of the facet, so far
};

}  // namespace

bool looks_like_stl(const FileStart& start) {
  if (is_binary(start)) return true;
  std::string_view rest = start.first_bytes;
  const std::size_t begin = rest.find_first_not_of(" \t\r\n\v\f");
  if (begin == std::string_view::npos) return false;
  rest.remove_prefix(begin);
  constexpr std::string_view kSolid = "solid";
  for (std::size_t i = 0; i < kSolid.size(); ++i) {
    if (i == rest.size() || (rest[i] | 0x20) != kSolid[i]) return false;
  }
  // A table may have a column of this name, but then numbers follow. A binary file of the wrong size has
  // zeros.
  if (rest.find('\0') != std::string_view::npos) return true;
  rest.remove_prefix(std::min(rest.find('\n'), rest.size()));
  std::string_view word;
  rest.remove_prefix(std::min(rest.find_first_not_of("\n\r\t\v\f "), rest.size()));
  rest = rest.substr(0, rest.find('\n'));
  if (!next_field(rest, ' ', word)) return true;
  return (word[0] | 0x20) == 'f' || (word[0] | 0x20) == 'e';
}

std::unique_ptr<ScanReader> open_stl(const std::filesystem::path& file, const ReadOptions&) {
  InputFile in(file);
  const FileStart start{.first_bytes = in.peek(4096), .size = in.remaining()};
  const auto triangles = count_triangles(start);
  if (is_binary(start)) return std::make_unique<BinaryStl>(file, *triangles);
  if (start.first_bytes.find('\0') != std::string_view::npos) {
    in.fail_at_byte(start.size,
                    "neither ASCII nor a binary STL" +
                        (triangles ? " of " + std::to_string(*triangles) + " triangles, which has " +
                                         std::to_string(kHeaderBytes + kTriangleBytes * *triangles) + " bytes"
                                   : ", which has a header of 84 bytes") +
                        "; the size must fit");
  }
  return std::make_unique<AsciiStl>(file);
}

}  // namespace lacuna::io
