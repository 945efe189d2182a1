#include "tools/summary.hpp"

#include "tools/terminal.hpp"
#include "tools/visible_text.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <sstream>

#include <sys/resource.h>

namespace lacuna {
namespace {

constexpr std::size_t kMostRows = 20;

std::string print_measure(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

std::string print_share(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3f", value);
  return buffer;
}

std::string print_position(const Eigen::Vector3d& position) {
  char buffer[128];
  std::snprintf(buffer, sizeof buffer, "%.9g %.9g %.9g", position.x(), position.y(), position.z());
  return buffer;
}

std::string print_input(const Counts& counts, const FileScan& scan) {
  std::string text = print_count(counts.points) + " points";
  text += scan.files().size() == 1 ? " in " + visible(scan.files().front().string())
                                   : " in " + std::to_string(scan.files().size()) + " files, as one scan";
  text += print_left_out(counts, scan.filtered_out());
  if (counts.thinned_out > 0) text += "; " + print_count(counts.thinned_out) + " represented by another";
  if (counts.duplicates > 0) text += "; " + print_count(counts.duplicates) + " at the place of another";
  return text + "\n";
}

std::string print_findings(const Summary& summary) {
  const Counts& counts = summary.counts;
  std::vector<std::vector<std::string>> rows = {
      {"boundary points", print_count(counts.boundary_points)},
      {"candidates, of them coherent", print_count(counts.candidates) + ", " + print_count(counts.coherent)},
      {"loops before selection", print_count(counts.raw_loops)},
      {"mean neighbours, mean edge length",
       print_measure(summary.mean_neighbours) + ", " + print_measure(summary.mean_edge_length)},
      {"tiles, points per tile at most",
       print_count(summary.tiles) + ", " + print_count(summary.tile_points)},
  };
  if (summary.resolution > 0) {
    const std::uint64_t representatives = counts.points - counts.dropped - counts.thinned_out;
    rows.insert(rows.begin(), {"representatives, one per cell of",
                               print_count(representatives) + ", " + print_measure(summary.resolution)});
  }
  if (summary.e > 0) {  // the method of the paper
    rows.push_back({"eligible edges, components",
                    print_count(counts.boundary_edges) + ", " + print_count(counts.components)});
    rows.push_back({"shortest loop (e)", "more than " + std::to_string(summary.e) + " edges"});
  }
  if (counts.undefined_normals > 0) {
    rows.push_back({"points without a normal", print_count(counts.undefined_normals)});
  }
  return print_table(rows);
}

std::string print_times(const Summary& summary, const RunTimes& times) {
  std::vector<PhaseTime> phases = summary.phases;
  phases.push_back({"write", times.write_seconds});
  phases.push_back({"all", times.total_seconds});
  std::vector<std::vector<std::string>> rows = {{"phase", "time", "rate"}};
  for (const PhaseTime& phase : phases) {
    rows.push_back(
        {phase.name, print_duration(phase.seconds), print_rate(summary.counts.points, phase.seconds)});
  }
  return print_table(rows);
}

std::string print_loops(const Detection& detection) {
  const std::vector<LoopMeasures>& loops = detection.loops();
  std::vector<std::size_t> order(loops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&loops](std::size_t a, std::size_t b) {
    return loops[a].perimeter > loops[b].perimeter;
  });

  std::vector<std::vector<std::string>> rows = {
      {"kind", "points", "perimeter", "area", "diameter", "planarity", "confidence", "centroid", "first id"}};
  for (std::size_t i = 0; i < std::min(order.size(), kMostRows); ++i) {
    const LoopMeasures& loop = loops[order[i]];
    rows.push_back({name_of(loop.kind), print_count(loop.points), print_measure(loop.perimeter),
                    print_measure(loop.area), print_measure(loop.diameter), print_share(loop.planarity),
                    print_share(loop.confidence), print_position(loop.centroid),
                    std::to_string(value(detection.read_loop(order[i]).points.front().id))});
  }
  std::string text = print_table(rows);
  if (order.size() > kMostRows) text += "  and " + print_count(order.size() - kMostRows) + " more\n";
  return text;
}

std::string counted(std::size_t count, const char* one, const char* several) {
  return print_count(count) + " " + (count == 1 ? one : several);
}

}  // namespace

std::string print_left_out(const Counts& counts, const FilteredOut& filtered) {
  std::string text;
  const auto add = [&text](std::uint64_t points, const char* why) {
    if (points > 0) text += "; " + print_count(points) + " " + why;
  };
  add(counts.dropped - filtered.total(), "not finite, dropped");
  add(filtered.origin, "without return");
  add(filtered.bounds, "outside of the bounds");
  add(filtered.classes, "of other classes");
  add(filtered.returns, "of other returns");
  return text;
}

std::string print_summary(const Detection& detection, const FileScan& scan, const RunTimes& times) {
  const Summary& summary = detection.summary();
  const std::vector<LoopMeasures>& loops = detection.loops();
  const auto holes = static_cast<std::size_t>(std::count_if(
      loops.begin(), loops.end(), [](const LoopMeasures& loop) { return loop.kind == LoopKind::kHole; }));

  std::string text = print_input(summary.counts, scan) + print_findings(summary) + "\n";
  text += print_times(summary, times);
  text += "  peak memory " + print_size(peak_memory()) + " of " + print_size(summary.memory_limit) + ", " +
          counted(summary.threads, "thread", "threads") + "\n\n";
  text += counted(holes, "hole", "holes") + ", " +
          counted(loops.size() - holes, "outer boundary", "outer boundaries") + "\n";
  if (!loops.empty()) text += print_loops(detection);
  return text + "\n";
}

std::string print_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string table;
  for (const auto& row : rows) {
    table += "  " + row[0] + std::string(widths[0] - row[0].size(), ' ');
    for (std::size_t i = 1; i < row.size(); ++i) {
      table += "  " + std::string(widths[i] - row[i].size(), ' ') + row[i];
    }
    table += '\n';
  }
  return table;
}

std::string print_count(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
}

std::string print_size(std::uint64_t bytes) {
  constexpr const char* kNames[] = {"KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  if (bytes < 1024) return std::to_string(bytes) + " bytes";
  double size = static_cast<double>(bytes) / 1024;
  std::size_t unit = 0;
  while (size >= 1024) {
    size /= 1024;
    ++unit;
  }
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, size < 10 ? "%.1f %s" : "%.0f %s", size, kNames[unit]);
  return buffer;
}

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace lacuna
