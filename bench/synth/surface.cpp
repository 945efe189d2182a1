// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/surface.hpp"

#include "bench/synth/hole_field.hpp"
#include "bench/synth/positions.hpp"
#include "bench/synth/surface_shape.hpp"
#include "bench/synth/truth_file.hpp"
#include "bench/synth/truth_loops.hpp"
#include "engine/run/error.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

namespace lacuna::synth {
using namespace io;

namespace {

void require(bool holds, const std::string& message) {
  if (!holds) throw UsageError(message);
}

bool is_square(std::uint32_t value) {
  std::uint32_t root = 0;
  while (root * root < value) ++root;
  return root * root == value;
}

void check(const SurfaceOptions& o) {
  require(o.spacing > 0 && o.spacing <= 1e6, "--spacing: must be above 0, at most 1e6 units of the scan");
  require(o.holes <= 10'000'000, "--holes: must be at most 10 million");
  require(o.hole_radius[0] >= 1.5 && o.hole_radius[0] <= o.hole_radius[1] && o.hole_radius[1] <= 1e6,
          "--hole-radius: needs 1.5 <= smallest <= largest <= 1e6 spacings");
  require(o.jitter >= 0 && o.jitter <= 0.5, "--jitter: must be 0 to 0.5 of the spacing");
  require(o.noise >= 0 && o.noise <= 1e3, "--noise: must be 0 to 1000 spacings");
  require(o.density_step >= 1 && o.density_step <= 100 && is_square(o.density_step),
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

// Makes places on the surface, with noise along its normal.
class PointMaker {
 public:
  PointMaker(const SurfaceGrid& grid, const SurfaceOptions& options)
      : shape_(grid, options),
        noise_(options.noise * options.spacing),
        translate_{options.translate[0], options.translate[1], options.translate[2]},
        height_(options.seed, 2) {}

  Vec3 at(GridPosition place, std::uint64_t number) const {
    const SurfacePoint p = shape_.at(place.row, place.column);
    if (noise_ == 0) return p.position + translate_;
    return p.position + noise_ * height_.normal(number) * p.normal + translate_;
  }

 private:
  SurfaceShape shape_;
  double noise_;
  Vec3 translate_;
  Random height_;
};

}  // namespace

SurfaceSummary write_surface(const SurfaceOptions& options) {
  check(options);
  const std::filesystem::path truth_path = truth_file_of(options.out, options.truth);
  NewFile truth_output(truth_path, kTruthMark, options.overwrite);
  OutputFile& truth_file = truth_output.content();
  NewFile scan(options.out, kScanMark, options.overwrite);
  PlyOutput ply(scan.content(), options.coordinates, Extras::kNone);

  const SurfaceGrid grid = lay_grid(options);
  check_precision(grid, options);
  const HoleField holes(grid, options);
  const std::unique_ptr<Positions> positions = make_positions(grid, holes, options);
  const PointMaker points(grid, options);
  const Permutation shuffled(positions->size(), options.seed);
  TruthLoops truth(positions->true_loops(), holes.size());

  for (std::uint64_t turn = 0; turn < positions->size(); ++turn) {
    const std::uint64_t number = options.order == Order::kRandom ? shuffled(turn) : turn;
    const std::optional<GridPosition> place = positions->at(number);
    if (!place) continue;
    truth.note(number, ply.count());
    ply.add(points.at(*place, number));
  }

  const auto in_ids = truth.in_ids();
  write_truth_head(truth_file, options.out);
  for (const auto& [ids, is_hole] : in_ids) write_loop(truth_file, is_hole ? "hole" : "outer edge", ids);
  ply.finish();
  truth_output.commit();
  scan.commit();
  return {.points = ply.count(), .loops = in_ids.size(), .truth = truth_path};
}

}  // namespace lacuna::synth
