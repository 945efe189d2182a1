// SPDX-License-Identifier: Apache-2.0
#include "io/read/ply/ply_writer.hpp"
#include "io/write/results/local_coordinates.hpp"
#include "io/write/results/results.hpp"

namespace lacuna::io {

void write_boundary(const Detection& detection, const ScanFiles& scan, const OutputConfig& config,
                    OutputFile& out) {
  PlyElement vertex{.name = "vertex",
                    .count = detection.summary.counts.boundary_points,
                    .properties = position_and_id(detection, scan, config)};
  const Scalar coordinate = vertex.properties.front().type;
  const Scalar id = vertex.properties.back().type;
  vertex.properties.insert(vertex.properties.end() - 1, {"scalar_probability", Scalar::kFloat32, {}});
  vertex.properties.push_back({"scalar_loop", Scalar::kInt32, {}});
  vertex.properties.push_back({"quality", Scalar::kFloat32, {}});  // the probability as MeshLab has it
  PlyWriter writer(out, {vertex}, local_offset(detection, config));

  detection.for_each_boundary_point([&](const BoundaryPoint& point) {
    writer.put_position(coordinate, point.position());
    writer.put(point.probability);
    writer.put_as(id, static_cast<double>(value(point.id)));
    writer.put(point.loop);
    writer.put(point.probability);
  });
  writer.finish();
}

}  // namespace lacuna::io
