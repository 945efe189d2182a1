// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loops_reader.hpp"

#include "engine/run/error.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/ply/ply.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/readers.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

namespace lacuna::evaluation {

using namespace io;

// ---- Loops by ids

namespace {

constexpr double kIdsEnd = 0x1p53;  // from here on a double is no longer any whole number
constexpr std::size_t kLongestComment = 200;

// A column of whole numbers from 0 on, whatever its type.
std::vector<std::uint64_t> read_column(const std::filesystem::path& file, std::string_view name) {
  const auto reader = open_ply(file, {});
  const Property* property = reader->layout().find(name);
  if (!property) {
    throw Error(file.string() + ": element 'vertex' has no property " + in_quotes(name) +
                "; files as lacuna detect writes them have it");
  }
  constexpr std::size_t kRowsAtATime = 1 << 16;
  std::vector<std::uint64_t> column;
  std::vector<double> values;
  for (RowBatch batch; reader->next(batch, kRowsAtATime);) {
    load_column(batch, reader->layout().stride, *property, values);
    for (const double value : values) {
      const bool whole =
          value >= 0 && value < kIdsEnd && value == static_cast<double>(static_cast<std::uint64_t>(value));
      if (!whole) {
        throw Error(file.string() + ": vertex " + std::to_string(column.size()) + " (from 0): '" +
                    std::string(name) + "' is " + std::to_string(value) +
                    "; a whole number from 0 on is needed");
      }
      column.push_back(static_cast<std::uint64_t>(value));
    }
  }
  return column;
}

TrueRows read_ply_loops(const std::filesystem::path& file) {
  const std::vector<std::uint64_t> ids = read_column(file, "scalar_id");
  const std::vector<std::uint64_t> loop_of = read_column(file, "scalar_loop");
  TrueRows rows;
  std::vector<NamedLoopIds>& loops = rows.loops;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const bool known = loop_of[i] + 1 == loops.size();
    if (!known && loop_of[i] != loops.size()) {
      throw Error(file.string() + ": vertex " + std::to_string(i) + " (from 0): loop " +
                  std::to_string(loop_of[i]) + " where " + std::to_string(loops.size()) +
                  " would be the next; loops must follow one after the other from 0 on");
    }
    if (!known) loops.emplace_back();
    loops.back().ids.push_back(ids[i]);
  }
  return rows;
}

// Returns the remainder of a comment's line, its words divided by one blank.
std::string read_comment(InputFile& in, std::string_view first) {
  std::string text(first);
  while (const auto word = in.next_word()) {
    if (text.size() + 1 + word->size() > kLongestComment) break;
    text.append(" ").append(*word);
  }
  return text;
}

// Returns "window" for "# window". The mark of the file is no name.
std::string name_in(std::string comment) {
  if (comment.starts_with(kLoopsTextMark)) return {};
  comment.erase(0, comment.find_first_not_of("# "));
  return comment;
}

std::uint64_t parse_id(const InputFile& in, std::string_view word) {
  std::uint64_t id = 0;
  if (!parse_number(word, id)) {
    in.fail_at_line(in.line() + 1, in_quotes(word) + " is not a point id, " +
                                       describe_number<std::uint64_t>() + "; a line is the ids of one loop");
  }
  return id;
}

// Without `has_marks`, marked rows are comments.
TrueRows read_rows(const std::filesystem::path& file, bool has_marks) {
  InputFile in(file);
  if (looks_like_ply({.first_bytes = in.peek(4), .size = in.remaining()})) return read_ply_loops(file);
  TrueRows rows;
  std::vector<NamedLoopIds> narrow;
  std::string name;
  while (in.next_row()) {
    LoopIds ids;
    std::string_view mark;
    while (const auto word = in.next_word()) {
      if (!word->starts_with('#') || !ids.empty() || !mark.empty()) {
        ids.push_back(parse_id(in, *word));
        continue;
      }
      name.clear();
      if (has_marks && *word == kStepMark) {
        mark = kStepMark;
      } else if (has_marks && *word == kNarrowMark) {
        mark = kNarrowMark;
      } else {
        if (word->size() <= kLongestComment) name = name_in(read_comment(in, std::string(*word)));
        break;
      }
    }
    while (!in.end_row()) in.next_word();  // the rest of a comment
    if (mark == kStepMark) {
      rows.steps.push_back(std::move(ids));
    } else if (mark == kNarrowMark) {
      narrow.push_back({std::move(ids), "narrow hole", true});
    } else if (!ids.empty()) {
      rows.loops.push_back({std::move(ids), std::exchange(name, "")});
    }
  }
  std::ranges::move(narrow, std::back_inserter(rows.loops));
  return rows;
}

}  // namespace

std::vector<LoopIds> read_loops(const std::filesystem::path& file) {
  std::vector<LoopIds> loops;
  for (NamedLoopIds& loop : read_rows(file, false).loops) loops.push_back(std::move(loop.ids));
  return loops;
}

TrueRows read_true_rows(const std::filesystem::path& file) {
  return read_rows(file, true);
}

std::vector<std::uint64_t> read_ids(const std::filesystem::path& file) {
  return read_column(file, "scalar_id");
}

// ---- Lines

namespace {

constexpr std::uint64_t kNone = ~std::uint64_t{0};

using Neighbours = std::array<std::uint64_t, 2>;  // along the curve; kNone where there is none yet

const PlyElement* element_named(const PlyHeader& header, std::string_view name) {
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
  const PlyElement& vertex = *element_named(header, "vertex");
  const PlyElement& edge = *element_named(header, "edge");
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
  std::vector<double> from, to;
  load_column(edges, stride, first, from);
  load_column(edges, stride, second, to);
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
  const PlyElement* const vertex = element_named(header, "vertex");
  if (vertex && vertex->layout().find("scalar_id")) return false;
  if (vertex && element_named(header, "edge")) return true;
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

// ---- Meshes

namespace {

const PlyElement& find_element(const InputFile& in, const PlyHeader& header, std::string_view name) {
  if (const PlyElement* const element = element_named(header, name)) return *element;
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

namespace {

using Positions = std::span<const Eigen::Vector3d>;

constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

// A half edge of a triangle (from, to, apex).
struct HalfEdge {
  std::uint64_t from, to, apex;

  std::pair<std::uint64_t, std::uint64_t> ends() const { return std::minmax(from, to); }
  std::uint64_t end_beside(std::uint64_t vertex) const { return from == vertex ? to : from; }
};

std::vector<HalfEdge> edges_on_one_triangle(std::span<const Triangle> triangles,
                                            std::span<const std::uint64_t> stand_ins) {
  std::vector<HalfEdge> all;
  for (const Triangle& triangle : triangles) {
    const std::uint64_t a = stand_ins[triangle[0]], b = stand_ins[triangle[1]], c = stand_ins[triangle[2]];
    if (a == b || b == c || c == a) continue;
    all.insert(all.end(), {HalfEdge{a, b, c}, HalfEdge{b, c, a}, HalfEdge{c, a, b}});
  }
  std::sort(all.begin(), all.end(), [](const HalfEdge& x, const HalfEdge& y) { return x.ends() < y.ends(); });
  std::vector<HalfEdge> once;
  for (std::size_t i = 0, end = 0; i < all.size(); i = end) {
    while (end < all.size() && all[end].ends() == all[i].ends()) ++end;
    if (end - i == 1) once.push_back(all[i]);
  }
  return once;
}

// Returns twice the area, along the normal.
Eigen::Vector3d normal_of(const HalfEdge& edge, Positions positions) {
  const Eigen::Vector3d& p = positions[edge.from];
  return (positions[edge.to] - p).cross(positions[edge.apex] - p);
}

// Returns the turn about the axis, counterclockwise from its tip: above 0, up to a whole one.
double turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d y = axis.cross(from), x = y.cross(axis);
  const double angle = std::atan2(to.dot(y) * axis.norm(), to.dot(x));
  return angle > 0 ? angle : angle + 2 * std::numbers::pi;
}

class BoundaryCurves {
 public:
  BoundaryCurves(std::vector<HalfEdge> edges, Positions positions)
      : edges_(std::move(edges)), positions_(positions), used_(edges_.size()) {
    for (std::size_t edge = 0; edge < edges_.size(); ++edge) {
      ends_.emplace_back(edges_[edge].from, edge);
      ends_.emplace_back(edges_[edge].to, edge);
    }
    std::sort(ends_.begin(), ends_.end());
    on_path_.assign(ends_.size(), kNowhere);
  }

  std::vector<TrueLoop> loops() {
    for (const bool open : {true, false}) {
      for (const auto& [vertex, edge] : ends_) {
        while (!used_[edge] && (!open || unused_at(vertex).size() % 2 == 1)) walk(vertex);
      }
    }
    std::sort(loops_.begin(), loops_.end(), [](const TrueLoop& a, const TrueLoop& b) {
      return std::tie(a.vertices, a.edges) < std::tie(b.vertices, b.edges);
    });
    return std::move(loops_);
  }

 private:
  using End = std::pair<std::uint64_t, std::size_t>;  // a vertex and an edge there

  std::size_t first_end(std::uint64_t vertex) const {
    return static_cast<std::size_t>(std::lower_bound(ends_.begin(), ends_.end(), End(vertex, 0)) -
                                    ends_.begin());
  }

  std::vector<std::size_t> unused_at(std::uint64_t vertex) const {
    std::vector<std::size_t> edges;
    for (std::size_t i = first_end(vertex); i < ends_.size() && ends_[i].first == vertex; ++i) {
      if (!used_[ends_[i].second]) edges.push_back(ends_[i].second);
    }
    return edges;
  }

  bool leaves(std::size_t edge, std::uint64_t vertex) const { return edges_[edge].from == vertex; }

  Eigen::Vector3d direction(std::uint64_t vertex, std::size_t edge) const {
    return positions_[edges_[edge].end_beside(vertex)] - positions_[vertex];
  }

  // Returns where the curve goes on from the vertex that it reached on `last`; empty if it ends.
  std::optional<std::size_t> edge_after(std::size_t last, std::uint64_t vertex) const {
    std::vector<std::size_t> next = unused_at(vertex);
    const bool leaving = !leaves(last, vertex);
    const auto opposes = [&](std::size_t edge) { return leaves(edge, vertex) != leaving; };
    if (!std::all_of(next.begin(), next.end(), opposes)) std::erase_if(next, opposes);
    if (next.empty()) return std::nullopt;
    if (next.size() == 1) return next.front();
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    for (std::size_t i = first_end(vertex); i < ends_.size() && ends_[i].first == vertex; ++i) {
      axis += normal_of(edges_[ends_[i].second], positions_);
    }
    if (!leaving) axis = -axis;  // the gap is on the other side
    const Eigen::Vector3d from = direction(vertex, last);
    const auto turn = [&](std::size_t edge) { return turn_between(from, direction(vertex, edge), axis); };
    return *std::min_element(next.begin(), next.end(),
                             [&](std::size_t a, std::size_t b) { return turn(a) < turn(b); });
  }

  // Follows a curve until it closes or ends, and makes a loop of every part that closes before.
  void walk(std::uint64_t start) {
    const std::vector<std::size_t> first = unused_at(start);
    const auto leaving =
        std::find_if(first.begin(), first.end(), [&](std::size_t edge) { return leaves(edge, start); });
    std::optional<std::size_t> edge = leaving == first.end() ? first.front() : *leaving;
    std::vector<End> path;
    std::uint64_t vertex = start;
    while (edge) {
      used_[*edge] = true;
      on_path_[first_end(vertex)] = path.size();
      path.emplace_back(vertex, *edge);
      vertex = edges_[*edge].end_beside(vertex);
      if (const std::size_t place = on_path_[first_end(vertex)]; place != kNowhere) cut(path, place);
      edge = path.empty() ? std::nullopt : edge_after(*edge, vertex);
    }
    if (path.empty()) return;
    cut(path, 0);
    loops_.back().vertices.push_back(vertex);
    std::sort(loops_.back().vertices.begin(), loops_.back().vertices.end());
  }

  // Makes a loop of the path from a place on.
  void cut(std::vector<End>& path, std::size_t place) {
    TrueLoop& loop = loops_.emplace_back();
    for (std::size_t i = place; i < path.size(); ++i) {
      const auto& [vertex, edge] = path[i];
      on_path_[first_end(vertex)] = kNowhere;
      loop.vertices.push_back(vertex);
      loop.edges.push_back({vertex, edges_[edge].end_beside(vertex)});
    }
    std::sort(loop.vertices.begin(), loop.vertices.end());
    path.resize(place);
  }

  std::vector<HalfEdge> edges_;
  Positions positions_;
  std::vector<bool> used_;            // of each edge
  std::vector<End> ends_;             // ascending
  std::vector<std::size_t> on_path_;  // of the first end of each vertex, its place on the path
  std::vector<TrueLoop> loops_;
};

}  // namespace

std::vector<TrueLoop> mesh_boundary(std::span<const Triangle> triangles,
                                    std::span<const std::uint64_t> stand_ins, Positions positions) {
  return BoundaryCurves(edges_on_one_triangle(triangles, stand_ins), positions).loops();
}

}  // namespace lacuna::evaluation
