// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/readers.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace lacuna::io {
namespace {

constexpr std::size_t kLongestLine = std::size_t{1} << 20;
constexpr const char* kVertex = "'v x y z', with one weight or three colours behind, is allowed";
constexpr const char* kNormal = "'vn x y z' is allowed";

constexpr std::array<std::string_view, 40> kKeywords = {
    "v",     "vt",       "vn",       "vp",     "f",          "fo",        "l",      "p",     "o",    "g",
    "s",     "mg",       "mtllib",   "usemtl", "usemap",     "maplib",    "cstype", "deg",   "bmat", "step",
    "curv",  "curv2",    "surf",     "parm",   "trim",       "hole",      "scrv",   "sp",    "end",  "con",
    "bevel", "c_interp", "d_interp", "lod",    "shadow_obj", "trace_obj", "ctech",  "stech", "call", "csh"};

std::string_view without_comment(std::string_view line) {
  return line.substr(0, line.find('#'));
}

// A comment does not go on: its last backslash may be of a path.
bool goes_on(std::string_view line) {
  while (!line.empty() && kBlanks.find(line.back()) != std::string_view::npos) line.remove_suffix(1);
  return line.ends_with('\\') && line.find('#') == std::string_view::npos;
}

// Joins lines where a backslash says so.
class ObjLines {
 public:
  explicit ObjLines(const std::filesystem::path& file) : in_(file) {}

  // Valid until the next call.
  std::optional<std::string_view> next() {
    const auto line = in_.next_line();
    if (!line || !goes_on(*line)) return line;
    joined_.clear();
    for (auto part = line; part; part = in_.next_line()) {
      const bool is_last = !goes_on(*part);
      joined_ += is_last ? *part : part->substr(0, part->rfind('\\'));
      joined_ += ' ';
      if (joined_.size() > kLongestLine) {
        in_.fail_at_line(in_.line(), "with the lines before that it continues longer than the " +
                                         std::to_string(kLongestLine) + " bytes allowed");
      }
      if (is_last) break;
    }
    return joined_;
  }

  // Returns the words behind the keyword of the next line that has this one; nothing at the end of the file.
  std::optional<LineWords> next(std::string_view keyword) {
    while (const auto line = next()) {
      LineWords words(in_, without_comment(*line));
      std::string_view word;
      if (words.next(word) && word == keyword) return words;
    }
    return std::nullopt;
  }

  const InputFile& in() const { return in_; }

 private:
  InputFile in_;
  std::string joined_;
};

// The facts that a pass over the file finds.
struct ObjContent {
  std::uint64_t vertices = 0;
  std::uint64_t normals = 0;
  std::uint64_t faces = 0;
  bool has_colours = false;
  bool has_own_normals = true;  // no face gives a vertex the normal of another number
};

// One corner of a face: "vertex", "vertex/texture", "vertex//normal" or "vertex/texture/normal". Numbers
// begin at 1; negative ones count back from the last so far.
bool has_own_normal(std::string_view corner, const ObjContent& so_far) {
  const std::size_t first = corner.find('/');
  const std::size_t second = first == std::string_view::npos ? first : corner.find('/', first + 1);
  if (second == std::string_view::npos) return true;
  std::int64_t vertex = 0, normal = 0;
  if (!parse_number(corner.substr(0, first), vertex)) return false;
  if (!parse_number(corner.substr(second + 1), normal)) return false;
  if (vertex < 0) vertex += static_cast<std::int64_t>(so_far.vertices) + 1;
  if (normal < 0) normal += static_cast<std::int64_t>(so_far.normals) + 1;
  return vertex == normal;
}

ObjContent survey(const std::filesystem::path& file) {
  ObjContent content;
  ObjLines lines(file);
  while (const auto line = lines.next()) {
    LineWords words(lines.in(), without_comment(*line));
    std::string_view word;
    if (!words.next(word)) continue;
    if (word == "v") {
      if (content.vertices == 0) content.has_colours = words.count_left() == 6;
      ++content.vertices;
    } else if (word == "vn") {
      ++content.normals;
    } else if (word == "f" || word == "fo") {
      ++content.faces;
      while (content.has_own_normals && words.next(word))
        content.has_own_normals = has_own_normal(word, content);
    }
  }
  return content;
}

class ObjReader final : public ScanReader {
 public:
  explicit ObjReader(const std::filesystem::path& file) : content_(survey(file)), vertices_(file) {
    if (content_.vertices == 0) vertices_.in().fail("has no vertex; lines 'v x y z' are needed");
    std::vector<std::pair<std::string, Scalar>> properties;
    for (const char* name : {"x", "y", "z"}) properties.emplace_back(name, Scalar::kFloat64);
    if (content_.has_colours) {
      for (const char* name : {"red", "green", "blue"}) properties.emplace_back(name, Scalar::kFloat32);
    }
    if (content_.normals == content_.vertices && content_.has_own_normals) {
      for (const char* name : {"nx", "ny", "nz"}) properties.emplace_back(name, Scalar::kFloat64);
      normals_.emplace(file);
    }
    layout_ = packed_layout(properties);
  }

  std::string format() const override { return "OBJ"; }
  const RowLayout& layout() const override { return layout_; }
  std::optional<std::uint64_t> expected_rows() const override { return content_.vertices; }
  std::vector<ReaderNote> notes() const override { return {note_of_faces(content_.faces)}; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    return fill_batch(batch, max_rows, layout_.stride, [&](std::byte* to) {
      auto vertex = vertices_.next("v");
      if (!vertex) return false;
      to = read_vertex(*vertex, to);
      if (normals_) read_normal(to);
      return true;
    });
  }

 private:
  void read_normal(std::byte* to) {
    auto normal = normals_->next("vn");
    if (!normal) normals_->in().fail("has fewer normals than when it was opened");
    for (int i = 0; i < 3; ++i) store_next(to, normal->number<double>(kNormal));
    normal->require_end(kNormal);
  }

  std::byte* read_vertex(LineWords& words, std::byte* to) const {
    for (int i = 0; i < 3; ++i) store_next(to, words.number<double>(kVertex));
    if (content_.has_colours) {
      for (int i = 0; i < 3; ++i) store_next(to, words.number<float>("the first vertex has a colour"));
    } else if (words.count_left() == 1) {
      words.number<double>(kVertex);
    } else if (words.count_left() == 3) {
      words.fail("a vertex with a colour; the first vertex has none");
    }
    words.require_end(kVertex);
    return to;
  }

  ObjContent content_;
  ObjLines vertices_;
  std::optional<ObjLines> normals_;  // read side by side with the vertices
  RowLayout layout_;
};

}  // namespace

bool looks_like_obj(const FileStart& start) {
  std::string_view rest = start.first_bytes;
  bool has_vertex = false, continues = false;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos && !start.is_whole()) break;
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    std::string_view words = line, word;
    const bool is_continued = std::exchange(continues, goes_on(line));
    if (is_continued || !next_field(words, ' ', word) || word.starts_with('#')) continue;
    if (std::find(kKeywords.begin(), kKeywords.end(), word) == kKeywords.end()) return false;
    has_vertex |= word == "v";
  }
  return has_vertex;
}

std::unique_ptr<ScanReader> open_obj(const std::filesystem::path& file, const ReadOptions&) {
  return std::make_unique<ObjReader>(file);
}

}  // namespace lacuna::io
