// The coordinate reference system that records of a LAS file name (LAS specification 1.4 R15, 2.5;
// GeoTIFF 1.1, 7.2 and annex B).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lacuna::io {

// Takes what the records "LASF_Projection" say, in any order.
class LasCrs {
 public:
  void take(std::uint16_t record, std::span<const std::byte> data);
  // Well-known text where a record has it, else "EPSG:N" or, with a vertical system, "EPSG:N+M" of the
  // GeoTIFF keys; empty: neither.
  std::string text() const;
  // "m", "ft", "us-ft"; empty: not known (io/length_unit.hpp).
  std::string length_unit() const;

 private:
  void take_keys(std::span<const std::byte> data);

  std::string well_known_text_;
  std::uint16_t geographic_ = 0, projected_ = 0, vertical_ = 0, unit_ = 0;  // codes of EPSG; 0: none
};

}  // namespace lacuna::io
