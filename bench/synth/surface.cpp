// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/surface.hpp"

#include "bench/synth/surface_points.hpp"
#include "engine/run/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lacuna::synth {

using namespace io;
using evaluation::NamedLoopIds;

namespace {

void check(const SurfaceOptions& o) {
  require(o.spacing > 0 && o.spacing <= 1e6, "--spacing: must be above 0, at most 1e6 units of the scan");
  require(o.holes <= 10'000'000, "--holes: must be at most 10 million");
  require(o.hole_radius[0] >= 1.5 && o.hole_radius[0] <= o.hole_radius[1] && o.hole_radius[1] <= 1e6,
          "--hole-radius: needs 1.5 <= smallest <= largest <= 1e6 spacings");
  require(o.jitter >= 0 && o.jitter <= 0.5, "--jitter: must be 0 to 0.5 of the spacing");
  require(o.noise >= 0 && o.noise <= 1e3, "--noise: must be 0 to 1000 spacings");
  require(o.density_step >= 1 && o.density_step <= 100 &&
              root_of(o.density_step) * root_of(o.density_step) == o.density_step,
          "--density-step " + std::to_string(o.density_step) +
              ": must be 1, 4, 9, ..., 100, the square of a stride");
  require(o.density_factor >= 1 && o.density_factor <= 100, "--density-factor: must be 1 to 100");
  for (const double offset : o.translate)
    require(std::fabs(offset) <= 1e12, "--translate: must be within 1e12 units of the scan");
}

// Floats have 24 bits. If neighbours would fall together, the user means doubles.
void check_precision(const SurfaceGrid& grid, const SurfaceOptions& options) {
  if (options.coordinates == Coordinates::kDouble) return;
  double reach = options.spacing * std::max(grid.rows, grid.columns);
  for (const double offset : options.translate) reach = std::max(reach, std::fabs(offset));
  require(reach * 0x1p-24 <= options.spacing / 16,
          "floats are too coarse for this size and --translate: spacing " + std::to_string(options.spacing) +
              " at coordinates of " + std::to_string(reach) + "; add --double");
}

// The true loops, whose numbers of points become ids of the points written. Holds the loops' points only,
// whatever the size of the surface.
class TruthLoops {
 public:
  // The first `holes` loops are the edges of holes, the others outer edges.
  TruthLoops(std::vector<NumberLoop> loops, std::size_t holes) : loops_(std::move(loops)), holes_(holes) {
    for (const NumberLoop& loop : loops_) numbers_.insert(numbers_.end(), loop.begin(), loop.end());
    matching::sort_once(numbers_);
    ids_.resize(numbers_.size());
  }

  // Records that the point of this number was written as the `id`-th. Points that are on no loop are ignored.
  void note(std::uint64_t number, std::uint64_t id) {
    const std::size_t place = place_of(number);
    if (place < numbers_.size() && numbers_[place] == number) ids_[place] = id;
  }

  // Call it after every point is recorded. Returns the loops as ids, in canonical form and sorted.
  std::vector<NamedLoopIds> in_ids() const {
    std::vector<NamedLoopIds> all;
    for (const NumberLoop& loop : loops_) {
      NumberLoop ids;
      for (const std::uint64_t number : loop) ids.push_back(ids_[place_of(number)]);
      to_canonical(ids);
      all.push_back({std::move(ids), all.size() < holes_ ? "hole" : "outer edge"});
    }
    std::ranges::sort(all, {}, &NamedLoopIds::ids);
    return all;
  }

 private:
  std::size_t place_of(std::uint64_t number) const {
    return static_cast<std::size_t>(std::lower_bound(numbers_.begin(), numbers_.end(), number) -
                                    numbers_.begin());
  }

  std::vector<NumberLoop> loops_;
  std::size_t holes_;
  std::vector<std::uint64_t> numbers_;  // of all loops, ascending, each once
  std::vector<std::uint64_t> ids_;      // of numbers_
};

}  // namespace

Made write_surface(const SurfaceOptions& options) {
  check(options);
  const std::filesystem::path truth_path = truth_file_of(options.out, options.truth);
  NewFile truth_output(truth_path, kTruthMark, options.overwrite);
  OutputFile& truth_file = truth_output.content();
  NewFile scan(options.out, kScanMark, options.overwrite);
  PlyOutput ply(scan.content(), options.coordinates, Extras::kNone);

  const SurfaceGrid grid = lay_grid(options);
  check_precision(grid, options);
  const std::unique_ptr<Positions> positions = make_positions(grid, options);
  const SurfaceShape shape(grid, options);
  const Random height(options.seed, 2);
  const auto [x, y, z] = options.translate;
  const Permutation shuffled(positions->size(), options.seed);
  TruthLoops truth(positions->true_loops(), options.holes);

  for (std::uint64_t turn = 0; turn < positions->size(); ++turn) {
    const std::uint64_t number = options.order == Order::kRandom ? shuffled(turn) : turn;
    const std::optional<GridPosition> place = positions->at(number);
    if (!place) continue;
    truth.note(number, ply.count());
    const SurfacePoint p = shape.at(place->row, place->column);
    const Vec3 lifted = options.noise == 0
                            ? p.position
                            : p.position + options.noise * options.spacing * height.normal(number) * p.normal;
    ply.add(lifted + Vec3{x, y, z});
  }

  const evaluation::TrueRows rows{.loops = truth.in_ids()};
  write_truth(truth_file, options.out, rows);
  ply.finish();
  truth_output.commit();
  scan.commit();
  return {.points = ply.count(), .loops = rows.loops.size(), .truth = truth_path};
}

}  // namespace lacuna::synth
