// open_stars: active points and wedges among the stars that a tile could not settle alone, once other tiles have
// told of theirs.
#pragma once

#include "engine/boundary/tangential/stored_stars.hpp"
#include "engine/model/tiling.hpp"
#include "engine/boundary/tangential/stars.hpp"
#include "engine/store/row_set.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lacuna {

// The star of `from`, in another tile, has the triangle (from, to, other); `to` is an owned point.
struct RemoteTriangle {
  LocalIndex to;
  std::uint32_t padding = 0;
  Row from, other;

  friend bool operator<(const RemoteTriangle& a, const RemoteTriangle& b);
};

// Whether any star in another tile has a triangle with this point. `remote_triangles`: sorted.
bool has_remote_triangle(std::span<const RemoteTriangle> remote_triangles, LocalIndex point);

// The measured stars of a tile that were not settled when it was evaluated: those of all points that may
// become active, but for points that are still `unmeasured`; these are not asked yet. `remote_triangles`: sorted; those
// of all foreign stars that are measured. Keeps references to all but the stars' corners.
class OpenStars {
 public:
  OpenStars(const Tile& tile, RowSet& active, const RowSet& unmeasured, const StoredStars& stars,
            std::span<const RemoteTriangle> remote_triangles);

  // Corners of refused triangles of active points are active, here and in other tiles: until there are no more.
  // visit(row): each point that was not before. Several tiles may be at it.
  void find_active_points(const std::function<void(Row)>& visit);

  // Each wedge of active points, in ascending row, now that all of these are known and measured.
  std::vector<Wedge> wedges();

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  Row row(std::size_t s) const { return tile_.row(points_[s].owned); }
  bool follow(std::uint32_t s, const std::function<void(Row)>& visit);
  bool is_refused(std::size_t s, std::uint32_t a, std::uint32_t b);
  bool refuses(std::uint32_t corner, std::size_t s, std::uint32_t other) const;

  const Tile& tile_;
  RowSet& active_;
  const RowSet& unmeasured_;
  std::span<const RemoteTriangle> remote_triangles_;
  std::span<const StoredStar> points_;
  Stars<Row> stars_;
  std::vector<std::uint32_t> star_of_;  // by owned index
};

}  // namespace lacuna
