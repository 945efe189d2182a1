// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/loops/lids_reader.hpp"
#include "io/ply/ply_writer.hpp"
#include "io/results/lids.hpp"
#include "io/results/local_coordinates.hpp"

#include <limits>
#include <string>

namespace lacuna::io {

void write_lids_ply(const std::filesystem::path& lids_obj, const Detection& detection, const ScanFiles& scan,
                    const OutputConfig& config, OutputFile& out) {
  std::uint64_t vertices = 0, triangles = 0;
  read_lids(lids_obj, {.hole = [&](const LidRecord& hole) {
              vertices += hole.vertices;
              triangles += hole.triangles;
            }});
  if (vertices > std::numeric_limits<std::int32_t>::max()) {
    throw Error(out.path().string() + ": " + std::to_string(vertices) +
                " vertices of lids; the format allows 2147483647");
  }
  const Scalar coordinate = coordinate_type(scan, config);
  const PlyElement vertex{.name = "vertex",
                          .count = vertices,
                          .properties = {{"x", coordinate, {}},
                                         {"y", coordinate, {}},
                                         {"z", coordinate, {}},
                                         {"scalar_loop", Scalar::kInt32, {}}}};
  const PlyElement face{
      .name = "face", .count = triangles, .properties = {{"vertex_indices", Scalar::kInt32, Scalar::kUint8}}};
  constexpr std::uint64_t kListBytes = sizeof(std::uint8_t) + 3 * sizeof(std::int32_t);
  PlyWriter writer(out, {vertex, face}, local_offset(detection, config), triangles * kListBytes);
  read_lids(lids_obj, {.vertex = [&](const LidRecord& hole, const Eigen::Vector3d& at) {
              writer.put_position(coordinate, at);
              writer.put(static_cast<std::int32_t>(hole.loop));
            }});
  read_lids(lids_obj, {.triangle = [&](const LidRecord&, const auto& corners) {
              writer.put(std::uint8_t{3});
              for (const std::uint64_t corner : corners) writer.put(static_cast<std::int32_t>(corner));
            }});
  writer.finish();
}

}  // namespace lacuna::io
