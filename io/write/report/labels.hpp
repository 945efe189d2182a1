// SPDX-License-Identifier: Apache-2.0
// Numbers on a picture.
#pragma once

#include "io/write/report/canvas.hpp"

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {

struct Label {
  std::uint64_t number = 0;
  Eigen::Vector2f middle{0, 0};  // in parts of the canvas
};

// What a number is of, and the box around it in parts of the canvas.
struct Labelled {
  std::uint64_t number = 0;
  Eigen::AlignedBox2f box;
};

// Returns the labels of the first ones, in their order; at most 60. A label stands in the middle of its box,
// or to the right of a box that is too small. It lies in the picture as a whole, and overlaps no earlier
// label.
std::vector<Label> place_labels(const std::vector<Labelled>& wanted, PictureSize size);

// Draws a number in dark digits before a pale border. Digits are about a fiftieth of the picture high, 14
// pixels at least.
void draw_label(const Label& label, PictureSize size, Canvas& canvas);

}  // namespace lacuna::io
