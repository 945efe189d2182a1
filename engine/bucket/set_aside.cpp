// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/set_aside.hpp"

#include "engine/run/error.hpp"
#include "engine/survey/survey.hpp"

#include <tuple>

namespace lacuna {
namespace {

// The tile that grows at the end of the store. Points come along the curve, copies one after the other. So a
// tile is full after its most points, and its cells are runs of the curve.
class LastTile {
 public:
  LastTile(StoreWriter& store, std::uint64_t most_points, std::uint64_t cell_points)
      : store_(store), most_points_(most_points), cell_points_(cell_points) {}

  bool is_full() const { return points_.size() == most_points_; }
  bool holds_copy_of(const ScanPoint& p) const {
    return !points_.empty() && points_.back().position() == p.position();
  }

  void add(const ScanPoint& point, const PlainNormal& normal, const ZPlace& place) {
    points_.push_back(point);
    if (store_.with_normals()) normals_.push_back(normal);
    places_.push_back(place);
  }

  // Adds a copy of the point that was added last.
  void add_copy(PointId id) {
    copies_.push_back({id, static_cast<LocalIndex>(points_.size() - 1)});
    if (copies_.size() == kCopies) send_copies();
  }

  void close() {
    if (points_.empty()) return;
    send_copies();
    std::vector<Cell> cells;
    std::uint32_t begin = 0;
    for (const std::uint32_t end : cut_runs(places_, cell_points_)) {
      Cell cell{.points = end - begin};
      for (; begin < end; ++begin) cell.box.extend(points_[begin].position());
      cells.push_back(cell);
    }
    store_.put(store_.reserve(points_.size()), points_, normals_, std::move(cells));
    points_.clear();
    normals_.clear();
    places_.clear();
  }

 private:
  static constexpr std::size_t kCopies = 4096;

  void send_copies() {
    store_.add_duplicates(store_.next_tile(), copies_);
    copies_.clear();
  }

  StoreWriter& store_;
  std::uint64_t most_points_, cell_points_;
  std::vector<ScanPoint> points_;
  std::vector<PlainNormal> normals_;
  std::vector<ZPlace> places_;
  std::vector<Duplicate> copies_;
};

}  // namespace

bool SetAside::Before::operator()(const Record& a, const Record& b) const {
  if (a.group != b.group) return a.group < b.group;
  if (a.place != b.place) return comes_before(a.place, b.place);
  return std::tie(a.point.x, a.point.y, a.point.z, a.point.id) <
         std::tie(b.point.x, b.point.y, b.point.z, b.point.id);
}

SetAside::SetAside(const TilePlan& plan, const Eigen::AlignedBox3d& bounds, std::filesystem::path file,
                   std::uint64_t memory)
    : plan_(plan), counts_(plan.groups()), sort_(std::move(file), memory) {
  for (const CountedCell& cell : plan.heavy)
    curves_.emplace_back(plan.grid.box(cell.coord, cell.coord).intersection(bounds));
  if (plan.far_points > 0) curves_.emplace_back(bounds);
  std::uint64_t points = 0;
  for (std::size_t group = 0; group < plan.groups(); ++group) points += plan.group_points(group);
  sort_.reserve(points);  // growth would hold them twice
}

void SetAside::add(std::uint32_t group, const ScanPoint& point, const PlainNormal& normal) {
  ++counts_[group];
  sort_.add({point, normal, curves_[group].place(point.position()), group});
}

void SetAside::store(StoreWriter& store, std::uint64_t cell_points) {
  for (std::size_t group = 0; group < counts_.size(); ++group) {
    const std::uint64_t counted = plan_.group_points(group);
    if (counts_[group] != counted && std::min(counts_[group], counted) < kMostCounted)
      fail_changed("not the points that were counted");
  }
  LastTile tile(store, plan_.tile_points, cell_points);
  std::uint64_t group = 0;
  sort_.for_each([&](const Record& record) {
    const bool is_next = record.group != group;
    if (!is_next && tile.holds_copy_of(record.point)) {
      tile.add_copy(record.point.id);
      return;
    }
    if (is_next || tile.is_full()) tile.close();
    group = record.group;
    tile.add(record.point, record.normal, record.place);
  });
  tile.close();
}

}  // namespace lacuna
