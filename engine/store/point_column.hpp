// SPDX-License-Identifier: Apache-2.0
// The points of the tile store on disk: one per row, in half of the bytes where nothing is lost by it.
#pragma once

#include "engine/model/points.hpp"
#include "engine/store/column.hpp"

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace lacuna {

// Single: every coordinate is a number of single precision, and every id is below 2^32.
enum class Precision : std::uint8_t { kSingle, kDouble };

// A point in single precision.
struct SinglePoint {
  float x, y, z;
  std::uint32_t id;

  SinglePoint() = default;
  explicit SinglePoint(const ScanPoint& p)
      : x(static_cast<float>(p.x)),
        y(static_cast<float>(p.y)),
        z(static_cast<float>(p.z)),
        id(static_cast<std::uint32_t>(value(p.id))) {}
  ScanPoint point() const { return {x, y, z, PointId{id}}; }
  bool is(const ScanPoint& p) const { return (x == p.x) & (y == p.y) & (z == p.z) & (id == value(p.id)); }
};
// Fails because the scan has more digits than the survey found.
[[noreturn]] void fail_digits();

// Reads and writes may come from several threads.
class PointColumn {
 public:
  PointColumn(StoreFile file, Precision precision);

  // Writes points. Throws `Error` where the precision would lose a digit. A scan that was surveyed has no
  // such point.
  void write(std::uint64_t row, std::span<const ScanPoint> points);
  void read(std::uint64_t row, std::span<ScanPoint> points) const;
  std::vector<ScanPoint> read(std::uint64_t row, std::size_t count) const;

  Digest digest(std::uint64_t row, std::uint64_t count) const;  // of the bytes of some rows

  Precision precision() const;
  StoreFile& file();
  const StoreFile& file() const;

 private:
  void write_single(Column<SinglePoint>& column, std::uint64_t row, std::span<const ScanPoint> points);

  using Columns = std::variant<Column<SinglePoint>, Column<ScanPoint>>;
  Columns column_;
};

}  // namespace lacuna
