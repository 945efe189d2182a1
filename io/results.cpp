#include "io/results.hpp"

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"

#include <functional>
#include <limits>

namespace lacuna {

void check_output_folder(const FileScan& scan, const std::filesystem::path& folder) {
  for (const char* name : {"loops.ply", "boundary.ply", "points.ply", "holes.json"}) {
    for (const auto& file : scan.files()) {
      std::error_code error;  // when there is no such result yet, nothing can be lost
      if (std::filesystem::equivalent(folder / name, file, error)) {
        throw Error(file.string() +
                    ": is an input in the place of a result; another output folder is needed");
      }
    }
  }
}

void write_results(const Detection& detection, const FileScan& scan, const Config& config,
                   const std::filesystem::path& folder) {
  check_output_folder(scan, folder);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(folder.string() + ": the folder cannot be made: " + error.message());

  OutputSet set(folder);
  std::vector<std::function<void()>> writers;
  const auto add = [&](const std::string& name, auto&& write) {
    writers.push_back([&out = set.add(name), write] { write(out); });
  };
  add("loops.ply", [&](OutputFile& out) { write_loops(detection, scan, out); });
  add("boundary.ply", [&](OutputFile& out) { write_boundary(detection, scan, out); });
  if (config.output.points)
    add("points.ply", [&](OutputFile& out) { write_points(detection, scan, config.output, out); });
  add("holes.json", [&](OutputFile& out) { write_report(detection, scan, config, out); });
  const Crew crew(static_cast<std::size_t>(config.run.threads));
  crew.for_each(writers.size(), [&](std::size_t i) { writers[i](); });
  scan.check_unchanged();
  set.commit({"holes.json", "points.ply"});
}

std::vector<PlyProperty> position_and_id(const Detection& detection, const FileScan& scan) {
  const Scalar coordinate = scan.single_precision() ? Scalar::kFloat32 : Scalar::kFloat64;
  const bool small = detection.summary().counts.points <= std::numeric_limits<std::uint32_t>::max();
  return {{"x", coordinate, {}},
          {"y", coordinate, {}},
          {"z", coordinate, {}},
          {"id", small ? Scalar::kUint32 : Scalar::kFloat64, {}}};
}

}  // namespace lacuna
