#include "io/results/json.hpp"
#include "io/results/results.hpp"

#include <fstream>
#include <sstream>
#include <thread>

namespace lacuna::io {
namespace {

double points_per_second(std::uint64_t points, double seconds) {
  return static_cast<double>(points) / seconds;
}

// The most memory this process has held so far.
Json peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    std::istringstream words(line);
    std::string key;
    std::uint64_t kilobytes = 0;
    if (words >> key && key == "VmHWM:" && words >> kilobytes) return kilobytes * 1024;
  }
  return nullptr;
}

}  // namespace

void write_run(const Detection& detection, const Config& config, OutputFile& out) {
  const Summary& summary = detection.summary();
  Json json = begin_json("run 1");
  json["parameters"] = parameter_values(config, [](std::string_view section) { return section == "run"; });
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
  json["peak_memory_bytes"] = peak_memory_bytes();
  json["cores"] = std::thread::hardware_concurrency();
  out.write(print(json, 2) + "\n");
}

}  // namespace lacuna::io
