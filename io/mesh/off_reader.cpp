// SPDX-License-Identifier: Apache-2.0
#include "io/mesh/off_reader.hpp"

#include "io/files/line_words.hpp"
#include "io/rows/scalar.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace lacuna::io {
namespace {

constexpr const char* kCounts = "the numbers of vertices, of faces and of edges are needed";
constexpr const char* kFace = "a face is the number of its vertices, then their indices";

// The part of "CNOFF" before OFF, and what follows the word; some writers leave no blank before a number.
struct Keyword {
  std::string_view kind;
  std::string_view rest;
};

std::optional<Keyword> find_keyword(std::string_view line) {
  const std::size_t begin = std::min(line.find_first_not_of(kBlanks), line.size());
  line.remove_prefix(begin);
  const std::size_t place = line.find("OFF");
  if (place == std::string_view::npos || line.substr(0, place).find_first_not_of("STCN4n") < place) {
    return std::nullopt;
  }
  const Keyword keyword{.kind = line.substr(0, place), .rest = line.substr(place + 3)};
  std::string_view rest = keyword.rest, word;
  const bool is_apart = rest.empty() || kBlanks.find(rest[0]) != std::string_view::npos;
  if (!next_field(rest, ' ', word)) return keyword;
  const bool is_number = word.find_first_not_of("0123456789") == std::string_view::npos;
  if (is_number || (is_apart && (word == "BINARY" || word.starts_with('#')))) return keyword;
  return std::nullopt;
}

std::string_view before_comment(std::string_view line) {
  return line.substr(0, line.find('#'));
}

bool is_blank(std::string_view line) {
  return line.find_first_not_of(kBlanks) == std::string_view::npos;
}

class OffReader final : public ScanReader {
 public:
  explicit OffReader(const std::filesystem::path& file) : in_(file) {
    read_header();
    require_size();
    set_layout();
    left_ = vertices_;
  }

  std::string format() const override { return kind_ + "OFF"; }
  const RowLayout& layout() const override { return layout_; }
  std::optional<std::uint64_t> expected_rows() const override { return vertices_; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    assert(max_rows > 0);
    const std::size_t rows = std::min(max_rows, kBatchBytes / layout_.stride);
    batch.count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, rows));
    batch.bytes.resize(batch.count * layout_.stride);
    if (batch.count == 0) {
      finish();
      return false;
    }
    std::byte* to = batch.bytes.data();
    for (std::size_t row = 0; row < batch.count; ++row)
      to = read_vertex(next_data(vertices_, "vertices"), to);
    left_ -= batch.count;
    return true;
  }

 private:
  void read_header() {
    std::string_view line;
    do {
      const auto next = in_.next_line();
      if (!next) in_.fail_at_line(in_.line(), "the file ends here without 'OFF'");
      line = *next;
    } while (is_blank(before_comment(line)));
    const auto keyword = find_keyword(line);
    if (!keyword) in_.fail_at_line(in_.line(), "'OFF', 'COFF', 'NOFF' or 'CNOFF' expected");
    kind_ = keyword->kind;
    LineWords words(in_, keyword->rest);
    if (std::string_view word; words.next(word) && word == "BINARY") {
      in_.fail_at_line(in_.line(), "binary OFF cannot be read; OFF as text is allowed");
    }
    if (kind_ != "" && kind_ != "C" && kind_ != "N" && kind_ != "CN" && kind_ != "NC") {
      in_.fail_at_line(in_.line(), "vertices of kind " + in_quotes(kind_ + "OFF") +
                                       " cannot be read; allowed are OFF, COFF, NOFF and CNOFF");
    }
    std::string_view counts = before_comment(keyword->rest);
    while (is_blank(counts)) {
      const auto next = in_.next_line();
      if (!next) in_.fail_at_line(in_.line(), std::string("the file ends here; ") + kCounts);
      counts = before_comment(*next);
    }
    LineWords numbers(in_, counts);
    vertices_ = numbers.number<std::uint64_t>(kCounts);
    faces_ = numbers.number<std::uint64_t>(kCounts);
    if (numbers.count_left() > 0) numbers.number<std::uint64_t>(kCounts);
    numbers.require_end(kCounts);
  }

  bool has_normals() const { return kind_.find('N') != std::string::npos; }
  bool has_colours() const { return kind_.find('C') != std::string::npos; }

  // The least size is a digit and a blank for each value, but the last line may have no end.
  void require_size() const {
    std::uint64_t least = 6;
    if (has_normals()) least += 6;
    if (has_colours()) least += 6;
    const std::uint64_t left = in_.remaining() + 1;
    if (vertices_ > left / least || faces_ > (left - vertices_ * least) / 2) {
      in_.fail_at_byte(in_.position() + in_.remaining(), "the file ends here, too early for the " +
                                                             std::to_string(vertices_) + " vertices and " +
                                                             std::to_string(faces_) +
                                                             " faces of its header; it must be complete");
    }
  }

  void set_layout() {
    std::vector<std::pair<std::string, Scalar>> properties;
    for (const char* name : {"x", "y", "z"}) properties.emplace_back(name, Scalar::kFloat64);
    if (has_normals()) {
      for (const char* name : {"nx", "ny", "nz"}) properties.emplace_back(name, Scalar::kFloat64);
    }
    if (has_colours()) {
      for (const char* name : {"red", "green", "blue"}) properties.emplace_back(name, Scalar::kFloat32);
      if (vertices_ > 0) {
        first_ = next_data(vertices_, "vertices");
        if (LineWords(in_, first_).count_left() == properties.size() + 1) {
          properties.emplace_back("alpha", Scalar::kFloat32);
        }
      }
    }
    layout_ = packed_layout(properties);
  }

  // The next line that holds something, without its comment.
  std::string_view next_data(std::uint64_t count, const char* what) {
    if (!first_.empty()) {
      row_ = std::move(first_);
      first_.clear();
      return row_;
    }
    while (const auto line = in_.next_line()) {
      const std::string_view data = before_comment(*line);
      if (!is_blank(data)) return data;
    }
    in_.fail_at_line(in_.line(), "the file ends here with fewer than the " + std::to_string(count) + " " +
                                     what + " of its header; it must be complete");
  }

  std::byte* read_vertex(std::string_view line, std::byte* to) const {
    constexpr const char* kNeeded = "every vertex must have as many values as its kind or the first one";
    LineWords words(in_, line);
    for (const Property& property : layout_.properties) {
      with_type(property.type, [&](auto value) {
        value = words.number<decltype(value)>(kNeeded);
        std::memcpy(to, &value, sizeof value);
        to += sizeof value;
      });
    }
    words.require_end(kNeeded);
    return to;
  }

  void finish() {
    for (; faces_ > 0; --faces_) {
      LineWords words(in_, next_data(faces_, "faces"));
      const auto corners = words.number<std::uint32_t>(kFace);
      if (words.count_left() < corners) words.fail(std::string("fewer values than needed; ") + kFace);
    }
    while (const auto line = in_.next_line()) {
      if (!is_blank(before_comment(*line))) {
        in_.fail_at_line(in_.line(),
                         "more data after the last face that the header counts; its counts must hold");
      }
    }
  }

  InputFile in_;
  std::string kind_;
  std::uint64_t vertices_ = 0;
  std::uint64_t faces_ = 0;  // not yet passed
  RowLayout layout_;
  std::uint64_t left_ = 0;  // vertices not yet read
  std::string first_;       // the first vertex, read to count its colours
  std::string row_;
};

}  // namespace

bool looks_like_off(const FileStart& start) {
  std::string_view rest = start.first_bytes;
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    if (!is_blank(before_comment(line))) return find_keyword(line).has_value();
  }
  return false;
}

std::unique_ptr<ScanReader> open_off(const std::filesystem::path& file, const ReadOptions&) {
  return std::make_unique<OffReader>(file);
}

}  // namespace lacuna::io
