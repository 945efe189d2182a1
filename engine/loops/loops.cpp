// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/loops.hpp"

#include "engine/store/column.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace lacuna {

void Loops::add(std::uint64_t count, const LoopEvidence& evidence,
                const std::function<LoopPoint(std::uint64_t)>& point) {
  const std::lock_guard lock(*mutex_);
  index_.push_back({points_.size(), count, point(0).id, evidence});
  ColumnWriter<LoopPoint> writer(points_);
  for (std::uint64_t i = 0; i < count; ++i) writer.add(point(i));
  writer.finish();
}

void Loops::for_each_point(std::size_t loop, const std::function<void(const LoopPoint&)>& visit) const {
  constexpr std::uint64_t kBlock = 1024;
  const Entry& entry = index_[loop];
  std::vector<LoopPoint> block(std::min(kBlock, entry.count));
  for (std::uint64_t i = 0; i < entry.count; i += block.size()) {
    block.resize(std::min(kBlock, entry.count - i));
    points_.read(entry.first + i, std::span(block));
    for (const LoopPoint& point : block) visit(point);
  }
}

int Loops::compare(const Loops& a, const Entry& i, const Loops& b, const Entry& j) {
  if (i.first_id != j.first_id) return i.first_id < j.first_id ? -1 : 1;
  if (i.count != j.count) return i.count < j.count ? -1 : 1;
  ColumnReader<LoopPoint> of_a(a.points_), of_b(b.points_);
  for (std::uint64_t k = 0; k < i.count; ++k) {
    const PointId id_a = of_a[i.first + k].id, id_b = of_b[j.first + k].id;
    if (id_a != id_b) return id_a < id_b ? -1 : 1;
  }
  return 0;
}

int compare_points(const Loops& a, std::size_t i, const Loops& b, std::size_t j) {
  return Loops::compare(a, a.index_[i], b, b.index_[j]);
}

void Loops::write(PartWriter& part) const {
  part.add("loops", index_);
  ColumnReader<LoopPoint> points(points_);
  add_in_blocks<LoopPoint>(part, "points", 0, [&](auto&& visit) {
    for (std::uint64_t i = 0; i < points_.size(); ++i) visit(points[i]);
  });
}

Loops Loops::read(const PartReader& part, std::filesystem::path file) {
  Loops loops(std::move(file));
  loops.index_ = part.records<Entry>("loops");
  ColumnWriter<LoopPoint> writer(loops.points_);
  part.for_each<LoopPoint>("points", 0, [&](std::span<const LoopPoint> points) {
    for (const LoopPoint& point : points) writer.add(point);
  });
  writer.finish();
  return loops;
}

void Loops::sort() {
  std::sort(index_.begin(), index_.end(), [&](const Entry& a, const Entry& b) {
    const int order = &a == &b ? 0 : compare(*this, a, *this, b);
    return order != 0 ? order < 0 : a.evidence.is_coarse < b.evidence.is_coarse;
  });
}

void order_by_place(std::span<LoopPoint> loop) {
  const auto comes_first = [](const LoopPoint& a, const LoopPoint& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  if (loop.size() < 2) return;
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end(), comes_first), loop.end());
  if (comes_first(loop.back(), loop[1])) std::reverse(loop.begin() + 1, loop.end());
}

}  // namespace lacuna
