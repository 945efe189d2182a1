// A picture of a scan and its holes, drawn by the processor alone.
#pragma once

#include "io/report/scene.hpp"
#include "io/results/output_set.hpp"

#include <cstddef>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

struct Picture {
  std::size_t width = 0, height = 0;
  std::vector<Colour> pixels;  // row by row from the top
};

// A parallel projection: what is seen lies in a box around `middle`.
struct View {
  Eigen::Vector3f right{1, 0, 0}, up{0, 1, 0}, towards{0, 0, 1};  // unit, orthogonal; `towards` the viewer
  Eigen::Vector3f middle{0, 0, 0};
  float half_height = 1;  // of the picture, in units of the scan
  float half_depth = 0;   // what lies further before or behind the middle is not drawn; 0: no bound
};

// The view of this name: "oblique", "top", "front", "side", or the id of a loop, seen along its normal. The
// picture holds nearly all points, or the loop with as much around it. Throws `Error` for any other name.
View find_view(const Scene& scene, std::string_view name, std::size_t width, std::size_t height);

// Points are discs, grey to red by their boundary probability, or as they came where `as_it_came` is set and
// the scan has colours. Curves of holes and outer curves have the colours of loops.ply. Cost: about 0.1 us a
// point.
Picture render(const Scene& scene, const View& view, std::size_t width, std::size_t height, bool as_it_came);

// By which an own picture is recognised: its first text, behind the sizes.
FileMark picture_mark();

// PNG, 8 bits for each colour.
void write_png(const Picture& picture, OutputFile& out);

}  // namespace lacuna::io
