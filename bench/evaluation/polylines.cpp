// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/polylines.hpp"

#include "engine/run/error.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/ply/ply.hpp"
#include "io/read/rows/columns.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace lacuna::evaluation {
using namespace io;

namespace {

constexpr std::uint64_t kNone = ~std::uint64_t{0};

using Neighbours = std::array<std::uint64_t, 2>;  // along the curve; kNone where there is none yet

const PlyElement* find_element(const PlyHeader& header, std::string_view name) {
  const auto found = std::ranges::find(header.elements, name, &PlyElement::name);
  return found == header.elements.end() ? nullptr : &*found;
}

Property find_end(const InputFile& in, const PlyElement& edge, std::string_view name) {
  const RowLayout layout = edge.layout();
  const Property* const property = layout.find(name);
  if (!property || !is_integer(property->type))
    in.fail_at_line(in.line(), "element 'edge' has no integer " + in_quotes(name));
  return *property;
}

std::vector<double> read_ends(const RowBatch& rows, std::size_t stride, const Property& property) {
  std::vector<double> ends;
  load_column(rows, stride, property, ends);
  return ends;
}

std::uint64_t checked_vertex(const InputFile& in, double vertex, std::size_t edge, std::size_t vertices) {
  if (vertex >= 0 && vertex < static_cast<double>(vertices)) return static_cast<std::uint64_t>(vertex);
  in.fail("edge " + std::to_string(edge) + " (from 0): vertex " +
          std::to_string(static_cast<std::int64_t>(vertex)) + "; the file has " + std::to_string(vertices) +
          ", counted from 0");
}

void add_neighbour(const InputFile& in, std::vector<Neighbours>& all, std::uint64_t of, std::uint64_t other) {
  Neighbours& neighbours = all[of];
  const auto free = std::ranges::find(neighbours, kNone);
  if (free == neighbours.end())
    in.fail("vertex " + std::to_string(of) + " (from 0) has more than two edges; a loop does not branch");
  *free = other;
}

std::vector<Neighbours> read_neighbours(InputFile& in) {
  const PlyHeader header = read_ply_header(in);
  const PlyElement& vertex = *find_element(header, "vertex");
  const PlyElement& edge = *find_element(header, "edge");
  const Property first = find_end(in, edge, "vertex1"), second = find_end(in, edge, "vertex2");
  require_size(in, header);
  const auto vertices = static_cast<std::size_t>(vertex.count);
  const std::size_t stride = edge.layout().stride;
  RowBatch edges{.count = static_cast<std::size_t>(edge.count), .bytes = {}};
  edges.bytes.resize(edges.count * stride);
  for (const PlyElement& element : header.elements) {
    if (&element == &edge) {
      read_rows(in, header.format, element, element.count, edges.bytes.data());
    } else {
      skip_rows(in, header.format, element);
    }
  }
  require_end(in);
  const std::vector<double> from = read_ends(edges, stride, first), to = read_ends(edges, stride, second);
  std::vector<Neighbours> neighbours(vertices, {kNone, kNone});
  for (std::size_t i = 0; i < edges.count; ++i) {
    const std::uint64_t a = checked_vertex(in, from[i], i, vertices);
    const std::uint64_t b = checked_vertex(in, to[i], i, vertices);
    add_neighbour(in, neighbours, a, b);
    add_neighbour(in, neighbours, b, a);
  }
  return neighbours;
}

}  // namespace

bool has_polylines(const std::filesystem::path& file) {
  InputFile in(file);
  const PlyHeader header = read_ply_header(in);
  const PlyElement* const vertex = find_element(header, "vertex");
  if (vertex && vertex->layout().find("scalar_id")) return false;
  if (vertex && find_element(header, "edge")) return true;
  throw Error(
      file.string() +
      ": has no loops; a PLY file needs a property 'scalar_id' of its vertices, or an element 'edge'");
}

std::vector<LoopIds> read_polylines(const std::filesystem::path& file) {
  InputFile in(file);
  const std::vector<Neighbours> neighbours = read_neighbours(in);
  std::vector<bool> done(neighbours.size());
  std::vector<LoopIds> loops;
  for (std::uint64_t start = 0; start < neighbours.size(); ++start) {
    if (done[start] || neighbours[start][0] == kNone) continue;
    LoopIds& loop = loops.emplace_back();
    for (std::uint64_t at = start, before = kNone; !done[at];) {
      const auto [one, other] = neighbours[at];
      if (other == kNone)
        in.fail("vertex " + std::to_string(at) + " (from 0) has one edge; a loop is closed");
      done[at] = true;
      loop.push_back(at);
      const std::uint64_t next = one == before ? other : one;
      before = at;
      at = next;
    }
  }
  return loops;
}

}  // namespace lacuna::evaluation
