// SPDX-License-Identifier: Apache-2.0
// loops_reader: loops from files. Results are loops.ply of `lacuna detect`, text, or lines of other programs.
// The truth is text, or the boundary of a mesh.
//
// Idea: loops are rows of ids of points, whatever the file. So text and columns of a PLY file are read as
// they are. Lines are followed from vertex to vertex, and the boundary of a mesh around its triangles.
//
// Source: docs/evaluate.md, which says what the files hold. Cost: n log n.
#pragma once

#include "io/explain/matching/match_loops.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::evaluation {

using namespace matching;

// ---- Loops by ids: what `lacuna detect` writes as loops.ply, and text

// Reads loops.ply in the order of its property "scalar_loop", which counts from 0 without gaps. In text, a
// line has one loop, ids divided by blanks; lines that are blank or begin with # are passed over. Returns no
// loop for a file without loops. Throws `Error`.
std::vector<LoopIds> read_loops(const std::filesystem::path& file);

struct NamedLoopIds {
  LoopIds ids;
  std::string name;  // empty without a name
  bool is_narrow = false;
};

// What a file of true loops has. Loops that are too narrow to count follow the others.
struct TrueRows {
  std::vector<NamedLoopIds> loops;
  std::vector<LoopIds> steps;
};

// The first line of a file of true loops begins with this text. The line is about the file and names no loop.
inline constexpr std::string_view kLoopsTextMark = "# one boundary loop per line, 0-based point ids of ";

// In a file of true loops, a line of ids that is no true loop begins with one of these. Other readers take it
// for a comment. In a row of ids, neighbours are joined by an edge. A step of density is closed where its
// first id is its last, too. A hole that is too narrow to count is closed, as a true loop is.
inline constexpr std::string_view kStepMark = "#step", kNarrowMark = "#narrow";

// Reads loops with their names, and the rows with a mark. In text, the comment in the line before a loop is
// its name, words divided by one blank. The name is cut to 200 bytes. A PLY file has neither names nor marks.
TrueRows read_true_rows(const std::filesystem::path& file);

// Returns the ids of boundary.ply, in file order. Throws `Error`.
std::vector<std::uint64_t> read_ids(const std::filesystem::path& file);

// ---- Loops of other programs, as lines of a PLY file

// Whether a PLY file has lines and no ids of points, so that its loops have vertices of their own. Throws
// `Error` if it has neither, or is no PLY file.
bool has_polylines(const std::filesystem::path& file);

// Returns the closed curves that element 'edge' makes of the vertices, by its integers 'vertex1' and
// 'vertex2'. Ids are places among the vertices. Loops are in the order of their first vertices; vertices
// without an edge are in no loop. Throws `Error` if a vertex has one edge, or more than two, or does not
// exist.
std::vector<LoopIds> read_polylines(const std::filesystem::path& file);

// ---- The true loops of a mesh

// Corners are rows of element "vertex".
using Triangle = std::array<std::uint64_t, 3>;

// Reads the polygons of list "vertex_indices" (or "vertex_index") of element "face", in file order. Each
// becomes a fan around its first corner; a polygon of fewer than three corners gives no triangle. Throws
// `Error` if the file is not a complete PLY, has no such list, or a face names a vertex that does not exist.
std::vector<Triangle> read_triangles(const std::filesystem::path& file);

// Every edge on exactly one triangle belongs to exactly one loop. Loops are simple. They come in the order of
// their vertices.
//
// A curve follows the directions in which the triangles pass their edges. At a vertex with several edges to
// go on, it crosses the gap in the mesh. It takes the first unused edge counterclockwise from the one on
// which it came. The view is against the mean normal of the triangles at these edges. Where the curve returns
// to a vertex, the part since then is a loop of its own.
//
// Where triangles disagree about their orientation, no edge may go on in the same direction; then any unused
// edge does. With edges on three triangles or more, curves may end. They begin and end at vertices with an
// odd number of boundary edges, and each is an open loop.
//
// Triangles with two corners at one place have no area and do not count. Cost: n log n.
std::vector<TrueLoop> mesh_boundary(std::span<const Triangle> triangles,
                                    std::span<const std::uint64_t> stand_ins,
                                    std::span<const Eigen::Vector3d> positions);

}  // namespace lacuna::evaluation
