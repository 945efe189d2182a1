// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/scattered_points.hpp"

#include <cstring>
#include <string_view>
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

}  // namespace lacuna
