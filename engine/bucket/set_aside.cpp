// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/set_aside.hpp"

#include "engine/run/error.hpp"
#include "engine/survey/survey.hpp"

#include <cstring>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace lacuna {
namespace {

constexpr std::string_view kPoints = "points";  // the stream of a part

template <class Record>
void pack_as(std::span<const ScanPoint> points, std::size_t step, std::byte* to) {
  bool is_exact = true;
  for (const ScanPoint& p : points) {
    const Record record(p);
    if constexpr (std::is_same_v<Record, SinglePoint>) is_exact &= record.is(p);
    std::memcpy(to, &record, sizeof record);
    to += step;
  }
  if (!is_exact) fail_digits();
}

template <class Record>
Record record_at(const std::byte* from) {
  Record record;
  std::memcpy(&record, from, sizeof record);
  return record;
}

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

std::size_t PointLayout::record_bytes() const {
  return (precision == Precision::kSingle ? sizeof(SinglePoint) : sizeof(ScanPoint)) +
         (with_normals ? sizeof(PlainNormal) : 0);
}

std::vector<std::byte> PointLayout::pack(std::span<const ScanPoint> points,
                                         std::span<const PlainNormal> normals) const {
  const std::size_t step = record_bytes();
  std::vector<std::byte> records(points.size() * step);
  if (precision == Precision::kSingle) {
    pack_as<SinglePoint>(points, step, records.data());
  } else {
    pack_as<ScanPoint>(points, step, records.data());
  }
  for (std::size_t i = 0; i < normals.size(); ++i)
    std::memcpy(&records[(i + 1) * step - sizeof(PlainNormal)], &normals[i], sizeof(PlainNormal));
  return records;
}

PointsAndNormals PointLayout::unpack(std::span<const std::byte> records) const {
  const std::size_t step = record_bytes(), count = records.size() / step;
  PointsAndNormals all;
  all.points.reserve(count);
  all.normals.reserve(with_normals ? count : 0);
  for (std::size_t i = 0; i < count; ++i) {
    const std::byte* const record = &records[i * step];
    all.points.push_back(precision == Precision::kSingle ? record_at<SinglePoint>(record).point()
                                                         : record_at<ScanPoint>(record));
    if (with_normals) all.normals.push_back(record_at<PlainNormal>(record + step - sizeof(PlainNormal)));
  }
  return all;
}

ScatteredPoints::ScatteredPoints(std::size_t places, PointLayout layout, const Spill& spill)
    : layout_(layout), lists_(std::make_unique<AppendBytes>(spill, "scattered", places)) {}

void ScatteredPoints::add(std::size_t place, std::span<const ScanPoint> points,
                          std::span<const PlainNormal> normals) {
  lists_->append(place, layout_.pack(points, normals));
}

void ScatteredPoints::for_each_packed(std::size_t place,
                                      const std::function<void(std::span<const std::byte>)>& visit) const {
  if (part_) return part_->for_each<std::byte>(kPoints, place, visit);
  lists_->for_each_block(place, layout_.record_bytes() << 13, visit);
}

void ScatteredPoints::for_each(std::size_t place, const VisitPoints& visit) const {
  for_each_packed(place, [&](std::span<const std::byte> records) { visit(layout_.unpack(records)); });
}

void ScatteredPoints::write(PartWriter& part) const {
  for (std::size_t place = 0; place < lists_->lists(); ++place)
    for_each_packed(place, [&](std::span<const std::byte> packed) { part.add(kPoints, place, packed); });
}

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
