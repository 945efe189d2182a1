// SPDX-License-Identifier: Apache-2.0
#include "io/read/ply/ply_camera.hpp"

#include "io/read/ply/ply_body.hpp"
#include "io/read/ply/ply_rows.hpp"
#include "io/read/rows/vectors.hpp"

#include <algorithm>
#include <vector>

namespace lacuna::io {
namespace {

constexpr VectorNames kViewpointNames = {"view_px", "view_py", "view_pz"};

bool states_viewpoint(const PlyElement& element) {
  return element.name == "camera" && element.count == 1 && has_vectors(element.layout(), kViewpointNames);
}

// The reader of the points checks these rows.
void pass_rows(InputFile& in, PlyFormat format, const PlyElement& element) {
  if (format == PlyFormat::kAscii && !element.has_lists()) {
    skip_ascii_lines(in, element);
  } else {
    skip_rows(in, format, element);
  }
}

}  // namespace

std::optional<Eigen::Vector3d> read_ply_camera(const std::filesystem::path& file, const PlyHeader& header) {
  const auto camera = std::find_if(header.elements.begin(), header.elements.end(), states_viewpoint);
  if (camera == header.elements.end()) return std::nullopt;
  InputFile in(file);
  read_ply_header(in);
  for (auto element = header.elements.begin(); element != camera; ++element)
    pass_rows(in, header.format, *element);
  const std::uint64_t begin = in.position();
  const RowLayout layout = camera->layout();
  RowBatch row{.count = 1, .bytes = std::vector<std::byte>(layout.stride)};
  read_rows(in, header.format, *camera, 1, row.bytes.data());
  std::vector<Eigen::Vector3d> places;
  load_vectors(row, layout, kViewpointNames, places);
  if (!places[0].allFinite()) {
    const std::string reason = "the camera is at no place; view_px, view_py and view_pz must be finite";
    if (header.format == PlyFormat::kAscii) in.fail_at_line(in.line(), reason);
    in.fail_at_byte(begin, reason);
  }
  return places[0];
}

}  // namespace lacuna::io
