// SPDX-License-Identifier: Apache-2.0
#include "engine/run/machine_memory.hpp"
#include "io/write/loops/json.hpp"
#include "io/write/results/results.hpp"

#include <thread>

namespace lacuna::io {
namespace {

double points_per_second(std::uint64_t points, double seconds) {
  return static_cast<double>(points) / seconds;
}

}  // namespace

void write_run(const Detection& detection, const ScanFiles& scan, const FilesConfig& config,
               OutputFile& out) {
  const Summary& summary = detection.summary;
  Json json = begin_json("run 1");
  json["parameters"] = parameter_values(config, [](std::string_view section) { return section == "run"; });
  put_crs(scan, json);
  json["points"] = summary.counts.points;
  json["tiling"] = {{"tiles", summary.tiles},
                    {"tile_points", summary.tile_points},
                    {"threads", summary.threads},
                    {"memory_limit_bytes", summary.memory_limit}};
  json["phases"] = Json::array();
  double total_seconds = 0;
  for (const PhaseTime& phase : summary.phases) {
    json["phases"].push_back(
        {{"name", phase.name},
         {"seconds", phase.seconds},
         {"points_per_second", points_per_second(summary.counts.points, phase.seconds)}});
    total_seconds += phase.seconds;
  }
  json["total_seconds"] = total_seconds;
  json["points_per_second"] = points_per_second(summary.counts.points, total_seconds);
  const std::uint64_t peak = peak_memory();
  json["peak_memory_bytes"] = peak > 0 ? Json(peak) : Json();
  json["cores"] = std::thread::hardware_concurrency();
  out.write(print(json, 2) + "\n");
}

}  // namespace lacuna::io
