// SPDX-License-Identifier: Apache-2.0
// The coordinate reference system that records of a LAS file name (LAS specification 1.4 R15, 2.5;
// GeoTIFF 1.1, 7.2 and annex B).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace lacuna::io {

// Takes what the records "LASF_Projection" say, in any order. Well-known text holds if the record has it,
// else the GeoTIFF keys.
class LasCrs {
 public:
  void take(std::uint16_t record, std::span<const std::byte> data);
  // After all records: where text and keys name two systems, the header's bit of well-known text decides.
  void choose(bool has_text_bit);
  // Returns well-known text, or "EPSG:N" of the keys, with a vertical system "EPSG:N+M". Returns an empty
  // text if the file has neither.
  std::string text() const;
  // Returns the other one of two systems; empty if the file names one.
  const std::string& other_text() const { return other_; }
  // Whether positions are longitude and latitude.
  bool is_geographic() const;
  // Returns "m", "ft", "us-ft"; empty if the unit is not known (io/read/crs/length_unit.hpp).
  std::string length_unit() const;
  // Returns the unit of what does not hold, if it is another one; else nothing.
  std::string other_unit() const;
  // Returns the unit of z likewise.
  std::string vertical_unit() const;

 private:
  void take_keys(std::span<const std::byte> data);
  bool has_text() const { return !well_known_text_.empty() && !do_keys_hold_; }
  std::string code_of_keys() const;
  bool is_projected() const;   // of the keys
  bool is_geocentric() const;  // likewise
  std::string unit_of_keys() const;

  std::string well_known_text_, other_;
  bool do_keys_hold_ = false;  // over well-known text
  // Codes of EPSG; 0 if absent.
  std::uint16_t geographic_ = 0, projected_ = 0, vertical_ = 0, unit_ = 0, vertical_unit_ = 0;
  std::vector<double> doubles_;                                      // to which keys refer
  std::size_t unit_size_ = std::numeric_limits<std::size_t>::max();  // the unit in metres, one of them
  std::uint16_t model_ = 0;                                          // 0: not stated
  bool has_projected_ = false;                                       // with a code or without
};

}  // namespace lacuna::io
