// Stars on their way from tile to tile, and the wedges that they leave.
#pragma once

#include "engine/model/boundary_graph.hpp"
#include "engine/model/ids.hpp"
#include "engine/boundary/tangential/star.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

// A star that is not settled within its tile. Its corners go by names that hold in all tiles.
struct StoredStar {
  PointId id;
  LocalIndex owned;
  StarPlace place;  // among the tile's stored corners
};

// A corner of one, and the consistency on the triangle that begins there.
struct StoredLinkVertex {
  Row point;
  float room;
  Consistency consistency;
};

// Stars of one tile and their corners.
struct StoredStars {
  std::vector<StoredStar> stars;
  std::vector<StoredLinkVertex> corners;

  void add(PointId id, LocalIndex owned) {
    stars.push_back({id, owned, {static_cast<std::uint32_t>(corners.size()), 0}});
  }
  void add_corner(const StoredLinkVertex& corner) {  // of the last star
    corners.push_back(corner);
    ++stars.back().place.size;
  }
  std::span<const StoredLinkVertex> operator[](const StoredStar& star) const {
    return std::span(corners).subspan(star.place.begin, star.place.size);
  }
};

// A point at the rim of the agreed triangles, and its neighbours along it. Between them, around the point,
// there is no agreed triangle.
struct Wedge {
  Vertex point;
  Row from, to;
  float room;  // of the largest ball that rests there
};

}  // namespace lacuna
