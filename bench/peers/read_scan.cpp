// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/peer.hpp"
#include "io/read/scan/scan_pass.hpp"

namespace lacuna::peers {

std::vector<float> read_scan(const char* file) {
  const io::ScanFiles files({file}, {});
  io::ScanPass scan(files);
  std::vector<float> coordinates;
  coordinates.reserve(3 * scan.expected_points().value_or(0));
  for (PointBatch batch; scan.next(batch);) {
    for (const Eigen::Vector3d& position : batch.positions) {
      if (!position.allFinite()) continue;
      for (const double coordinate : position) coordinates.push_back(static_cast<float>(coordinate));
    }
  }
  return coordinates;
}

}  // namespace lacuna::peers
