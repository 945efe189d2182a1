// SPDX-License-Identifier: Apache-2.0
// A picture of a scan and its holes, drawn by the processor alone: in bands, on a canvas with depth.
#pragma once

#include "io/read/files/output_file.hpp"
#include "io/write/report/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
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

// A parallel projection: the picture shows a box around `middle`.
struct View {
  Eigen::Vector3f right{1, 0, 0}, up{0, 1, 0}, towards{0, 0, 1};  // unit, orthogonal; `towards` the viewer
  Eigen::Vector3f middle{0, 0, 0};
  float half_height = 1;  // of the picture, in units of the scan
  float before =
      std::numeric_limits<float>::infinity();  // what is nearer than the middle by more is not drawn
  float highest = std::numeric_limits<float>::infinity();  // what is above is not drawn, from the origin
  std::optional<std::size_t> loop = std::nullopt;          // the chosen one, as an index
};

// Returns the view of this name: "oblique", "top", "front", "side", or the id of a loop. The picture holds
// what 98 in 100 of the points and the holes of confidence 0.9 or more need. A loop fills 0.6 of its
// width or height. A loop is seen along its normal from above. The other side, or a view 35 degrees aslant,
// takes its place where it shows at least a tenth more of the loop. What is shown begins 0.9 radii before the
// loop's middle, or 1.2 times as far as its foremost vertex, whichever is more. So no ceiling or wall hides
// the loop; the report's page has the same rule. Throws `Error` for any other name, and for a loop without
// vertices. Cost: up to ten pictures of 300 rows for a loop.
View find_view(const Scene& scene, std::string_view name, std::size_t width, std::size_t height);

// Returns the loop that a view of this name is of, as an index; nothing for the four others. Throws `Error`
// as find_view does.
std::optional<std::size_t> loop_of_view(const Scene& scene, std::string_view name);

struct PictureStyle {
  bool as_it_came = false;  // points keep the colours of the scan, where it has them
  bool has_ids = false;     // of loops
};

// Points are discs, grey to dark green by their boundary probability, if they do not keep their colours.
// Curves of holes and outer curves have the colours of loops.ply. Small loops are not drawn, but for a chosen
// one. A chosen loop is thick, and pale where the surface hides it; the others are thin and pale. What lies
// within the outline of a chosen hole and beyond its plane is pale, too. A loop has its id in the middle of
// what is seen of it, if that is half or more. The chosen one comes first, then the largest; no id overlaps
// another. `take_row` gets the rows from the top. The picture is drawn in bands of at most `band_bytes`, or
// of one row if that takes more; its pixels do not depend on them. Cost: about 0.1 us a point, and 0.01 us a
// point and band.
inline constexpr std::size_t kBandBytes = std::size_t{128} << 20;
void render(const Scene& scene, const View& view, PictureSize size, PictureStyle style,
            const std::function<void(std::span<const Colour> row)>& take_row,
            std::size_t band_bytes = kBandBytes);

// An earlier picture of this program is recognised by its first text, behind the sizes.
FileMark picture_mark();

// Writes a PNG, 8 bits for each colour, row by row from the top. Throws `Error` if the file cannot be
// written.
class PngWriter {
 public:
  PngWriter(PictureSize size, OutputFile& out);
  ~PngWriter();
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  void write(std::span<const Colour> row);
  void finish();  // once all rows are written

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lacuna::io
