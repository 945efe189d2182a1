// SPDX-License-Identifier: Apache-2.0
#include "engine/store/point_column.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <array>

namespace lacuna {
namespace {

// This many points at a time are turned into the other kind, in the cache.
constexpr std::size_t kPart = 4096;

}  // namespace

void fail_digits() {
  fail_changed("a coordinate has more digits than before");
}

PointColumn::PointColumn(StoreFile file, Precision precision)
    : column_(precision == Precision::kSingle
                  ? Columns(std::in_place_type<Column<SinglePoint>>, std::move(file))
                  : Columns(std::in_place_type<Column<ScanPoint>>, std::move(file))) {}

Precision PointColumn::precision() const {
  return std::holds_alternative<Column<SinglePoint>>(column_) ? Precision::kSingle : Precision::kDouble;
}

StoreFile& PointColumn::file() {
  return std::visit([](auto& column) -> StoreFile& { return column.file(); }, column_);
}

const StoreFile& PointColumn::file() const {
  return std::visit([](const auto& column) -> const StoreFile& { return column.file(); }, column_);
}

Digest PointColumn::digest(std::uint64_t row, std::uint64_t count) const {
  return std::visit([&](const auto& column) { return column.digest(row, count); }, column_);
}

void PointColumn::write(std::uint64_t row, std::span<const ScanPoint> points) {
  if (auto* const wide = std::get_if<Column<ScanPoint>>(&column_)) {
    wide->write(row, points);
  } else {
    write_single(std::get<Column<SinglePoint>>(column_), row, points);
  }
}

void PointColumn::write_single(Column<SinglePoint>& column, std::uint64_t row,
                               std::span<const ScanPoint> points) {
  std::array<SinglePoint, kPart> part;
  for (std::size_t first = 0; first < points.size(); first += kPart) {
    const std::size_t count = std::min(kPart, points.size() - first);
    bool is_exact = true;
    for (std::size_t i = 0; i < count; ++i) {
      part[i] = SinglePoint(points[first + i]);
      is_exact &= part[i].is(points[first + i]);
    }
    if (!is_exact) fail_digits();
    column.write(row + first, std::span(part).first(count));
  }
}

void PointColumn::read(std::uint64_t row, std::span<ScanPoint> points) const {
  if (const auto* const wide = std::get_if<Column<ScanPoint>>(&column_)) {
    wide->read(row, points);
    return;
  }
  const auto& single = std::get<Column<SinglePoint>>(column_);
  std::array<SinglePoint, kPart> part;
  for (std::size_t first = 0; first < points.size(); first += kPart) {
    const std::size_t count = std::min(kPart, points.size() - first);
    single.read(row + first, std::span(part).first(count));
    for (std::size_t i = 0; i < count; ++i) points[first + i] = part[i].point();
  }
}

std::vector<ScanPoint> PointColumn::read(std::uint64_t row, std::size_t count) const {
  std::vector<ScanPoint> points(count);
  read(row, std::span(points));
  return points;
}

}  // namespace lacuna
