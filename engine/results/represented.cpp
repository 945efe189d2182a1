// SPDX-License-Identifier: Apache-2.0
#include "engine/results/represented.hpp"

#include "engine/results/point_results.hpp"
#include "engine/store/outbox.hpp"

#include <utility>
#include <vector>

namespace lacuna {
namespace {

static_assert(kRepresentedBlock == kResultBlock);

struct SpreadResult {
  PointId id;
  PointResult result;
};

}  // namespace

std::unique_ptr<Detection> spread_results(std::unique_ptr<Detection> detection,
                                          AppendLists<Represented> represented_points, const Spill& spill) {
  const auto represented = std::make_shared<const AppendLists<Represented>>(std::move(represented_points));
  detection->for_each_result_block = [represented, spill,
                                      of_representatives =
                                          std::move(detection->for_each_result_block)](const auto& visit) {
    AppendLists<SpreadResult> spread(spill, "spread", represented->lists());
    Outbox<SpreadResult> outbox(spread);
    of_representatives([&](PointId first, std::span<const PointResult> block) {
      represented->for_each(value(first) / kResultBlock, [&](const Represented& r) {
        const PointResult& result = block[value(r.representative) - value(first)];
        outbox.add(static_cast<TileIndex>(value(r.id) / kResultBlock), {r.id, result});
      });
    });
    outbox.send();
    // Dropped points have no representative: the results are as they were.
    std::vector<PointResult> all;
    of_representatives([&](PointId first, std::span<const PointResult> block) {
      all.assign(block.begin(), block.end());
      spread.for_each(value(first) / kResultBlock,
                      [&](const SpreadResult& r) { all[value(r.id) - value(first)] = r.result; });
      visit(first, all);
    });
  };
  return detection;
}

}  // namespace lacuna
