// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/mesh_reader.hpp"

#include "io/read/files/input_file.hpp"
#include "io/read/ply/ply.hpp"
#include "io/read/rows/columns.hpp"

#include <span>

namespace lacuna::evaluation {
using namespace io;

namespace {

const PlyElement& find_element(const InputFile& in, const PlyHeader& header, std::string_view name) {
  for (const PlyElement& element : header.elements) {
    if (element.name == name) return element;
  }
  in.fail_at_line(in.line(),
                  "the header has no element " + in_quotes(name) + "; a mesh has vertices and faces");
}

std::size_t find_corners(const InputFile& in, const PlyElement& face) {
  for (std::size_t i = 0; i < face.properties.size(); ++i) {
    const PlyProperty& property = face.properties[i];
    if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
    if (property.count_type && is_integer(property.type)) return i;
  }
  in.fail_at_line(in.line(),
                  "element 'face' has no list of integers named 'vertex_indices' or 'vertex_index'");
}

}  // namespace

std::vector<Triangle> read_triangles(const std::filesystem::path& file) {
  InputFile in(file);
  const PlyHeader header = read_ply_header(in);
  const std::uint64_t vertices = find_element(in, header, "vertex").count;
  const PlyElement& face = find_element(in, header, "face");
  const std::size_t corners = find_corners(in, face);
  require_size(in, header);

  std::vector<Triangle> triangles;
  std::uint64_t read = 0;
  const auto add = [&](std::span<const std::int64_t> polygon) {
    for (const std::int64_t vertex : polygon) {
      if (vertex >= 0 && static_cast<std::uint64_t>(vertex) < vertices) continue;
      in.fail("face " + std::to_string(read) + " (from 0): vertex " + std::to_string(vertex) +
              "; the file has " + std::to_string(vertices) + ", counted from 0");
    }
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      triangles.push_back({static_cast<std::uint64_t>(polygon[0]), static_cast<std::uint64_t>(polygon[i - 1]),
                           static_cast<std::uint64_t>(polygon[i])});
    }
    ++read;
  };
  for (const PlyElement& element : header.elements) {
    if (&element != &face) {
      skip_rows(in, header.format, element);
    } else if (header.format == PlyFormat::kAscii) {
      visit_ascii_lists(in, face, corners, add);
    } else {
      visit_binary_lists(in, face, is_swapped(header.format), corners, add);
    }
  }
  require_end(in);
  return triangles;
}

}  // namespace lacuna::evaluation
