// SPDX-License-Identifier: Apache-2.0
// The colours of points as the scan has them: red, green and blue of any type, or grey by intensity.
#pragma once

#include "io/read/rows/scan_reader.hpp"
#include "io/write/report/scene.hpp"

#include <cstddef>
#include <vector>

namespace lacuna::io {

class ColourColumns {
 public:
  explicit ColourColumns(const RowLayout& layout);

  void load(const RowBatch& rows);
  void take(std::size_t row);  // of the batch that was loaded last
  void begin_file();           // the rows that are taken from now on are of another file

  // Returns one colour for each row taken; none if the layout has no colours. Values of a file have 16 bits
  // if any is above 255, as some programs write bytes there. Floats up to 1, or hardly more, are shares.
  // Intensities are stretched from their 2nd to their 98th percentile, of all files.
  std::vector<Colour> finish() const;

 private:
  const RowLayout& layout_;
  std::vector<const Property*> properties_;  // three, one or none
  std::vector<std::vector<double>> loaded_;  // of each
  std::vector<float> taken_;                 // row by row
  std::vector<std::size_t> files_ = {0};     // of each file, the first in taken_
};

}  // namespace lacuna::io
