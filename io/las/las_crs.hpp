// SPDX-License-Identifier: Apache-2.0
// The coordinate reference system that records of a LAS file name (LAS specification 1.4 R15, 2.5;
// GeoTIFF 1.1, 7.2 and annex B).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

// Takes what the records "LASF_Projection" say, in any order.
class LasCrs {
 public:
  void take(std::uint16_t record, std::span<const std::byte> data);
  // Returns well-known text if the record has it, else "EPSG:N" of the GeoTIFF keys, with a vertical system
  // "EPSG:N+M". Returns an empty text if the file has neither.
  std::string text() const;
  // Whether positions are longitude and latitude.
  bool is_geographic() const;
  // Returns "m", "ft", "us-ft"; empty if the unit is not known (io/crs/length_unit.hpp).
  std::string length_unit() const;
  // Returns the unit of the keys, where well-known text has another one; else nothing.
  std::string other_unit() const;
  // Returns the unit of z likewise.
  std::string vertical_unit() const;

 private:
  void take_keys(std::span<const std::byte> data);
  bool is_projected() const;   // of the keys
  bool is_geocentric() const;  // likewise
  std::string unit_of_keys() const;

  std::string well_known_text_;
  // Codes of EPSG; 0 if absent.
  std::uint16_t geographic_ = 0, projected_ = 0, vertical_ = 0, unit_ = 0, vertical_unit_ = 0;
  std::vector<double> doubles_;                                      // to which keys refer
  std::size_t unit_size_ = std::numeric_limits<std::size_t>::max();  // the unit in metres, one of them
  std::uint16_t model_ = 0;                                          // 0: not stated
  bool has_projected_ = false;                                       // with a code or without
};

}  // namespace lacuna::io
