// SPDX-License-Identifier: Apache-2.0
#include "tools/run/run_costs.hpp"

#include "engine/run/job.hpp"
#include "engine/run/parallel.hpp"
#include "engine/thin/thin.hpp"

#include <algorithm>
#include <cstddef>

namespace lacuna::tools {
namespace {

// Bytes of temporary files and microseconds of processor time for each point.
struct Rate {
  double bytes = 0;    // always on disk
  double spilled = 0;  // on disk only as far as `kListsInMemory` of the memory limit do not hold them
  double microseconds = 0;
};

// Measured on 2026-11-26: two threads, a two-core machine with other programs at work. Bytes are the largest
// sum of the files of the process, every 30 ms; microseconds are processor time. The rates are fitted to
// these scans, which differ by 2.5:
//   scan         M points  bytes a point, limit 12 GiB   256 MiB   microseconds
//   bun_zipper   0.04      122                           -         3.3
//   autzen       0.4       68                            -         3.5
//   vol_total    0.5       72                            157       2.3
//   dragon       0.8       76                            239       3.1
//   balm         1.7       148                           414       5.8
// The sums of the next two rates are in the middle of the table's values. --method paper on vol_total, 57 and
// 0.9, parts them.
constexpr Rate kEachPoint = {.bytes = 60, .spilled = 100, .microseconds = 1.2};
constexpr Rate kLevelsAbove = {.bytes = 40, .spilled = 100, .microseconds = 2.4};
// These rates were measured on the same day, as the difference to a default run of vol_total.
constexpr Rate kOrientedNormals = {.bytes = 26, .spilled = 24, .microseconds = 1.2};
constexpr Rate kKeptWorkspace = {.bytes = 100, .microseconds = 0.1};
// These rates were not measured alone. They are the sizes of records, in all files that hold them at a time.
constexpr Rate kDoublePrecision = {.bytes = 30};  // coordinates that floats cannot hold
constexpr Rate kGivenNormals = {.bytes = 40};
// For each row of the input. The bytes are sizes of records; the microseconds are measured on vol_total with
// --points, and with --resolution 1, which leaves out two of three points.
constexpr Rate kAnnotatedScan = {.spilled = 44, .microseconds = 0.2};
constexpr Rate kThinnedRow = {.bytes = 16, .spilled = 24};
constexpr Rate kDecodedOnce = {.bytes = 24, .microseconds = 0.8};  // autzen_trim.laz over .las

constexpr double kStartSeconds = 0.06;  // a process without a scan
constexpr double kListsInMemory = 1.0 / 8;
// An even scan takes this share of the bytes. A jittered grid of 4 M points takes 40 for each of them. One of
// 448 M takes 62 within 2 GiB.
constexpr double kLeastShare = 0.4;

class Sum {
 public:
  void add(double count, const Rate& rate) {
    sum_.bytes += count * rate.bytes;
    sum_.spilled += count * rate.spilled;
    sum_.microseconds += count * rate.microseconds;
  }
  RunCosts costs(double memory, double threads) const {
    const double spilled = std::max(0.0, sum_.spilled - kListsInMemory * memory);
    return {.least_disk = static_cast<std::uint64_t>(kLeastShare * sum_.bytes),
            .disk = static_cast<std::uint64_t>(sum_.bytes + spilled),
            .seconds = kStartSeconds + 1e-6 * sum_.microseconds / threads};
  }

 private:
  Rate sum_;
};

}  // namespace

RunCosts run_costs(const io::FileScan& scan, const Config& config, std::uint64_t rows, std::uint64_t points) {
  const auto of_rows = static_cast<double>(rows), of_points = static_cast<double>(points);
  Sum sum;
  sum.add(of_points, kEachPoint);
  if (has_levels(config)) sum.add(of_points, kLevelsAbove);
  if (!scan.single_precision()) sum.add(of_points, kDoublePrecision);
  if (scan.has_normals()) sum.add(of_points, kGivenNormals);
  if (config.normals.orient) sum.add(of_points, kOrientedNormals);
  if (!config.run.workspace.empty()) sum.add(of_points, kKeptWorkspace);
  if (config.results.points) sum.add(of_rows, kAnnotatedScan);
  if (points < rows) sum.add(of_rows, kThinnedRow);
  if (scan.reads_slowly()) sum.add(of_rows, kDecodedOnce);
  const TaskArena arena(static_cast<std::size_t>(config.run.threads));
  return sum.costs(static_cast<double>(Memory::share(config.run.memory_limit).limit),
                   static_cast<double>(arena.threads()));
}

}  // namespace lacuna::tools
