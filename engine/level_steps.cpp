// SPDX-License-Identifier: Apache-2.0
#include "engine/level_steps.hpp"

#include "engine/evaluate/evaluate_tiles.hpp"
#include "engine/halo/halo.hpp"
#include "engine/loops/rate_loops.hpp"
#include "engine/parts/kept_run.hpp"
#include "engine/parts/level_form.hpp"
#include "engine/thin/thin.hpp"

#include <string>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

// The numbers of found loops, as the part has them.
struct BoundaryNumbers {
  std::uint64_t edges, components;
  std::int64_t minimum_loop;
};

struct LoopsForm {
  double extent;
  const Spill& spill;

  std::optional<FoundLevel> read(const PartReader& part) const {
    const auto numbers = part.record<BoundaryNumbers>("boundary");
    return FoundLevel{
        read_totals(part, extent),
        {Loops::read(part, spill.file("loops")), numbers.edges, numbers.components, numbers.minimum_loop}};
  }
  static void write(const FoundLevel& found, PartWriter& part) {
    write_totals(found.totals, part);
    part.add_one("boundary", BoundaryNumbers{found.boundary.edges, found.boundary.components,
                                             found.boundary.minimum_loop});
    found.boundary.loops.write(part);
  }
};

// Returns what a level's evaluation is made from, and the level above.
std::string made_from(const Level& level, const StepContext& context) {
  return level.seal + evaluation_parameters(context.job.config);
}

// Levels above the first one have only the outputs of their loops.
PartKey outputs_key(const Level& level, const StepContext& context) {
  return {step_of_level(kEvaluate, level.number),
          {},
          made_from(level, context) + (level.number == 0 ? output_parameters(context.job.config) : "")};
}

// Evaluates the tiles that are not.
LengthBins distances_of(const Level& level, const StepContext& context) {
  const Consumers consumers(level, context.job);
  const TileOutputs outputs = evaluate_level(level, consumers.all, context);
  return read_totals(outputs, level.store.tiling(), level.extent).distances;
}

}  // namespace

std::optional<Level> share_of_level_above(const Level& below, const StepContext& context, std::size_t task) {
  const std::size_t number = below.number + 1;
  const PartKey key{step_of_level(kLevel, number),
                    {task, context.parts.plan.tasks_of_level(number)},
                    made_from(below, context)};
  const LevelForm form{context.parts, context.job, key.step};
  if (std::optional<Level> kept = context.parts.find(key, form)) return kept;
  const double edge = edge_above(below, below.distances ? *below.distances : distances_of(below, context));
  if (edge == 0) return std::nullopt;
  Level share = thin_above(below, key.share, edge, form.files(), context.job);
  if (key.share.tasks == 1 && share.store.tiling().points() < kFewestOfLevel) return std::nullopt;
  return context.parts.keep(key, form, std::move(share));
}

std::optional<Level> level_above(const Level& below, const StepContext& context) {
  std::vector<Level> shares;
  for (std::size_t task = 0; task < context.parts.plan.tasks_of_level(below.number + 1); ++task) {
    std::optional<Level> share = share_of_level_above(below, context, task);
    if (!share) return std::nullopt;
    shares.push_back(*std::move(share));
  }
  Level level = join_levels(std::move(shares), context.job.spill);
  return level.store.tiling().points() >= kFewestOfLevel ? std::optional(std::move(level)) : std::nullopt;
}

std::optional<Level> level_of_number(std::size_t number, const StepContext& context) {
  if (number == 0) return first_level(context);
  const std::optional<Level> below = level_of_number(number - 1, context);
  if (!below) return std::nullopt;
  return level_above(*below, context);
}

TileOutputs evaluate_level(const Level& level, std::span<const TileConsumer> consumers,
                           const StepContext& context, const TaskShare& share) {
  const Tiling& tiling = level.store.tiling();
  TileOutputs outputs(tiling, context.parts, outputs_key(level, context), context.job.spill);
  std::vector<TileIndex> tiles = outputs.missing();
  const TileRange range = tiling.tiles_in(share);
  std::erase_if(tiles, [&](TileIndex t) { return t < range.first || t >= range.last; });
  evaluate_tiles(level, tiles, exchange_halo(level.store, tiles, context.job), consumers, outputs,
                 context.job);
  return outputs;
}

FoundLevel loops_of_level(const Level& level, BoundaryMethod& method,
                          const std::function<const TileOutputs&()>& outputs_of, const StepContext& context) {
  const PartKey key{step_of_level(kLoops, level.number), {}, made_from(level, context)};
  return context.parts.get(key, LoopsForm{level.extent, context.job.spill}, [&] {
    const TileOutputs& outputs = outputs_of();
    Totals totals = read_totals(outputs, level.store.tiling(), level.extent);
    Phase phase(context.job.phases, "loops", 0);
    method.complete_edges(outputs);
    context.job.workers.memory.trim();
    method.stitch(outputs, totals);
    FoundLoops found = method.find_loops(outputs);
    if (context.job.config.loops.method == LoopMethod::kTangential)
      rate_loops(level.store, found.loops, context.job.spill, context.job.workers);
    return FoundLevel{std::move(totals), std::move(found)};
  });
}

}  // namespace lacuna
