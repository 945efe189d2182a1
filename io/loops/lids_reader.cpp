// SPDX-License-Identifier: Apache-2.0
#include "io/loops/lids_reader.hpp"

#include "io/files/input_file.hpp"
#include "io/files/line_words.hpp"

#include <optional>
#include <utility>

namespace lacuna::io {
namespace {

constexpr std::string_view kObject = "hole_";

std::uint64_t id_of(const LineWords& words, std::string_view name) {
  std::uint64_t id = 0;
  if (!name.starts_with(kObject) || !parse_number(name.substr(kObject.size()), id))
    words.fail(in_quotes(name) + " is no name of a hole");
  return id;
}

class LidLines {
 public:
  LidLines(InputFile& in, const LidVisits& visits) : in_(in), visits_(visits) {}

  void take(std::string_view line) {
    LineWords words(in_, line);
    std::string_view key;
    if (!words.next(key)) return;
    if (key == "#") {
      comment(words, line);
    } else if (key == "o") {
      std::string_view name;
      words.next(name);
      announce(id_of(words, name));
    } else if (key == "v" && visits_.vertex) {
      Eigen::Vector3d vertex;
      for (double& component : vertex) component = words.number<double>("a vertex has x y z");
      visits_.vertex(hole_, vertex);
    } else if (key == "f" && visits_.triangle) {
      std::array<std::uint64_t, 3> triangle;
      for (std::uint64_t& corner : triangle)
        corner = words.number<std::uint64_t>("a triangle has three vertices") - 1;
      visits_.triangle(hole_, triangle);
    }
  }

 private:
  void comment(LineWords& words, std::string_view line) {
    std::string_view name;
    words.next(name);
    if (const auto reason = line.find(kNoLid); reason != line.npos) {
      next_ = {.left_out = std::string(line.substr(reason + kNoLid.size()))};
      announce(id_of(words, name));
    }
    if (name == kLidVertices) next_.vertices = words.number<std::uint64_t>("a number of vertices");
    if (name == kLidTriangles) next_.triangles = words.number<std::uint64_t>("a number of triangles");
    if (name == kLidArea) next_.area = words.number<double>("an area");
  }

  void announce(std::uint64_t id) {
    hole_ = std::exchange(next_, {});
    hole_.loop = id;
    if (visits_.hole) visits_.hole(hole_);
  }

  InputFile& in_;
  const LidVisits& visits_;
  LidRecord hole_, next_;
};

}  // namespace

void read_lids(const std::filesystem::path& lids_obj, const LidVisits& visits) {
  InputFile in(lids_obj);
  LidLines lines(in, visits);
  while (const std::optional<std::string_view> line = in.next_line()) lines.take(*line);
}

}  // namespace lacuna::io
