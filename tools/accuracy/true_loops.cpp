#include "tools/accuracy/true_loops.hpp"

#include "engine/stitch/union_find.hpp"

#include <algorithm>
#include <numeric>

namespace lacuna::accuracy {
namespace {

using Edge = std::array<std::uint64_t, 2>;

std::array<double, 3> place_of(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

void sort_once(std::vector<std::uint64_t>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

Edge edge_between(std::uint64_t a, std::uint64_t b) {
  return {std::min(a, b), std::max(a, b)};
}

std::vector<std::uint64_t> ends_of(std::span<const Edge> edges) {
  std::vector<std::uint64_t> ends;
  for (const Edge& edge : edges) ends.insert(ends.end(), edge.begin(), edge.end());
  sort_once(ends);
  return ends;
}

std::vector<Edge> edges_on_one_triangle(std::span<const Triangle> triangles,
                                        std::span<const std::uint64_t> stand_ins) {
  std::vector<Edge> all;
  for (const Triangle& triangle : triangles) {
    const std::uint64_t a = stand_ins[triangle[0]], b = stand_ins[triangle[1]], c = stand_ins[triangle[2]];
    if (a == b || b == c || c == a) continue;
    all.insert(all.end(), {edge_between(a, b), edge_between(b, c), edge_between(c, a)});
  }
  std::sort(all.begin(), all.end());
  std::vector<Edge> once;
  for (std::size_t i = 0, end = 0; i < all.size(); i = end) {
    while (end < all.size() && all[end] == all[i]) ++end;
    if (end - i == 1) once.push_back(all[i]);
  }
  return once;
}

}  // namespace

std::vector<std::uint64_t> stand_ins(std::span<const Eigen::Vector3d> positions) {
  std::vector<std::uint64_t> stands_for(positions.size());
  std::iota(stands_for.begin(), stands_for.end(), std::uint64_t{0});
  std::vector<std::uint64_t> order;
  for (std::uint64_t id = 0; id < positions.size(); ++id) {
    if (positions[id].allFinite()) order.push_back(id);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::uint64_t a, std::uint64_t b) {
    return place_of(positions[a]) < place_of(positions[b]);
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (place_of(positions[order[i]]) == place_of(positions[order[i - 1]])) {
      stands_for[order[i]] = stands_for[order[i - 1]];
    }
  }
  return stands_for;
}

std::vector<TrueLoop> loops_through(std::span<const LoopIds> ids, std::span<const std::uint64_t> stand_ins) {
  std::vector<TrueLoop> loops;
  for (const LoopIds& line : ids) {
    TrueLoop& loop = loops.emplace_back();
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::uint64_t next = line[i + 1 < line.size() ? i + 1 : 0];
      loop.vertices.push_back(stand_ins[line[i]]);
      loop.edges.push_back(edge_between(stand_ins[line[i]], stand_ins[next]));
    }
    sort_once(loop.vertices);
  }
  return loops;
}

std::vector<TrueLoop> mesh_boundary(std::span<const Triangle> triangles,
                                    std::span<const std::uint64_t> stand_ins) {
  const std::vector<Edge> edges = edges_on_one_triangle(triangles, stand_ins);
  const std::vector<std::uint64_t> vertices = ends_of(edges);
  const auto place = [&](std::uint64_t id) {
    return static_cast<LocalIndex>(std::lower_bound(vertices.begin(), vertices.end(), id) - vertices.begin());
  };
  std::vector<LocalIndex> links(vertices.size());
  UnionFind pieces(links);
  for (const Edge& edge : edges) pieces.unite(place(edge[0]), place(edge[1]));

  // A piece's root is its lowest vertex, so pieces begin in the order of their lowest ids.
  std::vector<TrueLoop> loops;
  std::vector<std::size_t> loop_of(vertices.size());
  for (LocalIndex i = 0; i < vertices.size(); ++i) {
    const LocalIndex root = pieces.find(i);
    if (root == i) {
      loop_of[i] = loops.size();
      loops.emplace_back();
    }
    loop_of[i] = loop_of[root];
    loops[loop_of[i]].vertices.push_back(vertices[i]);
  }
  for (const Edge& edge : edges) loops[loop_of[place(edge[0])]].edges.push_back(edge);
  return loops;
}

EdgeTree tree_of_truth(std::span<const TrueLoop> truth, std::span<const Eigen::Vector3d> positions) {
  std::vector<Segment> edges;
  for (std::size_t loop = 0; loop < truth.size(); ++loop) {
    for (const auto& [a, b] : truth[loop].edges) edges.push_back({positions[a], positions[b], loop});
  }
  return EdgeTree(std::move(edges));
}

}  // namespace lacuna::accuracy
