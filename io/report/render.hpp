// SPDX-License-Identifier: Apache-2.0
// A picture of a scan and its holes, drawn by the processor alone.
#pragma once

#include "io/files/new_file.hpp"
#include "io/report/scene.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include <Eigen/Core>

namespace lacuna::io {

struct PictureSize {
  std::size_t width = 0, height = 0;  // pixels
};

// A parallel projection: the picture shows a box around `middle`.
struct View {
  Eigen::Vector3f right{1, 0, 0}, up{0, 1, 0}, towards{0, 0, 1};  // unit, orthogonal; `towards` the viewer
  Eigen::Vector3f middle{0, 0, 0};
  float half_height = 1;  // of the picture, in units of the scan
  float half_depth = 0;   // points further before or behind the middle are not drawn; 0: no bound
};

// Returns the view of this name: "oblique", "top", "front", "side", or the id of a loop, viewed along its
// normal. The picture holds nearly all points, or the loop with as much around it. Throws `Error` for any
// other name.
View find_view(const Scene& scene, std::string_view name, std::size_t width, std::size_t height);

// Points are discs, grey to red by their boundary probability. If `as_it_came` is set and the scan has
// colours, they keep these. Curves of holes and outer curves have the colours of loops.ply. `take_row` gets
// the rows from the top. The picture is drawn in bands of at most `band_bytes`, or of one row if that takes
// more; its pixels do not depend on them. Cost: about 0.1 us a point, and 0.01 us a point and band.
inline constexpr std::size_t kBandBytes = std::size_t{128} << 20;
void render(const Scene& scene, const View& view, PictureSize size, bool as_it_came,
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
