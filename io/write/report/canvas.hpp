// SPDX-License-Identifier: Apache-2.0
// A canvas with depth, for pictures that are drawn in bands, and numbers on it.
#pragma once

#include "io/write/report/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lacuna::io {

struct PictureSize {
  std::size_t width = 0, height = 0;  // pixels
};

// Pixels are drawn in so many by so many parts. Places and lengths on a canvas are in parts, from the top
// left corner of the whole picture.
inline constexpr int kFiner = 2;

inline const Eigen::Vector3f kPaper(255, 255, 255);

// A colour that is nearly paper.
inline Eigen::Vector3f pale(const Eigen::Vector3f& colour) {
  return kPaper - 0.25f * (kPaper - colour);
}

// Colours and depths of the parts of a picture's rows from `first_row` on. A larger depth is nearer. What
// lies outside of the canvas is not drawn.
class Canvas {
 public:
  static constexpr std::size_t kPixelBytes = kFiner * kFiner * (sizeof(Eigen::Vector3f) + sizeof(float));

  Canvas(PictureSize size, std::size_t first_row, std::size_t rows);

  int height() const { return height_; }  // of the whole picture
  // Whether anything between these heights may be on the canvas.
  bool reaches(float top, float bottom) const { return bottom >= float(first_) && top <= float(end_); }

  // A nearer part stays.
  void disc(float x, float y, float radius, float depth, const Eigen::Vector3f& colour);

  // Whether nothing nearer is at a place; never outside of the canvas.
  bool shows(float x, float y, float depth) const;

  // Draws over all that is there. What comes later is before or behind as if it were not there.
  void overlay(float x, float y, float radius, const Eigen::Vector3f& colour);
  void overlay_box(float left, float top, float right, float bottom, const Eigen::Vector3f& colour);

  // Makes pale what lies within a closed outline, by the even-odd rule, and beyond a plane. Its depth at (x,
  // y) is the scalar product of `plane` and (x, y, 1).
  void veil(const std::vector<Eigen::Vector3f>& outline, const Eigen::Vector3f& plane);

  // Calls `take_row` for each row of pixels, from the top.
  void take_rows(const std::function<void(std::span<const Colour>)>& take_row) const;

 private:
  template <class Visit>
  void for_each_between(int row, float left, float right, const Visit& visit) const;
  template <class Visit>
  void for_each_in_disc(float x, float y, float radius, const Visit& visit) const;

  int width_, height_, first_, end_;  // parts
  std::vector<Eigen::Vector3f> colours_;
  std::vector<float> depths_;
};

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
