// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/tile_curves.hpp"

#include "engine/stitch/union_find.hpp"

#include <algorithm>
#include <utility>

namespace lacuna::tangential {
namespace {

constexpr RecordStream<OpenChain> kChains{"chains"};
constexpr RecordStream<LocalIndex> kComponents{"components of chains"};
constexpr RecordStream<CurvePoint> kChainPoints{"points of chains"};
constexpr RecordStream<CurveTotals> kCurveTotals{"totals of curves"};
constexpr RecordStream<TileLoops::Entry> kLoops{"loops"};
constexpr RecordStream<LoopPoint> kLoopPoints{"points of loops"};

// Returns the links of a union-find over chains. Wedges of one point, which are next to each other, connect
// the chains that they are on.
std::vector<LocalIndex> connect_chains(std::span<const Wedge> wedges, std::span<const LocalIndex> chain_of,
                                       LocalIndex chains) {
  std::vector<LocalIndex> links(chains);
  UnionFind connected(links);
  for (std::size_t i = 1; i < wedges.size(); ++i) {
    if (wedges[i].row == wedges[i - 1].row) connected.unite(chain_of[i - 1], chain_of[i]);
  }
  return links;
}

// Numbers the components that have an open chain, and counts the others. `open`: the numbers of open chains.
void number_components(std::vector<LocalIndex> links, std::span<const LocalIndex> open, OpenChains& found) {
  UnionFind connected(links);
  std::vector<LocalIndex> number_of(links.size(), kNoIndex);  // by root
  LocalIndex numbers = 0;
  for (const LocalIndex chain : open) {
    LocalIndex& number = number_of[connected.find(chain)];
    if (number == kNoIndex) number = numbers++;
    found.components.push_back(number);
  }
  for (LocalIndex chain = 0; chain < links.size(); ++chain)
    found.totals.components += connected.find(chain) == chain && number_of[chain] == kNoIndex ? 1 : 0;
}

}  // namespace

OpenChains OpenChains::read(const TileOutputs& outputs, TileIndex tile) {
  OpenChains open{
      outputs.read(kChains, tile), outputs.read(kComponents, tile), outputs.read(kChainPoints, tile), {}};
  for (const CurveTotals& totals : outputs.read(kCurveTotals, tile)) open.totals = totals;
  return open;
}

void OpenChains::emit(TileOutput& output) && {
  output.add(kChains, std::move(chains));
  output.add(kComponents, std::move(components));
  output.add(kChainPoints, std::move(points));
  output.add(kCurveTotals, std::vector<CurveTotals>{totals});
}

std::uint64_t OpenChains::bytes(const TileOutputs& outputs, TileIndex tile) {
  return outputs.count(kChains, tile) * (sizeof(OpenChain) + sizeof(LocalIndex)) +
         outputs.count(kChainPoints, tile) * sizeof(CurvePoint);
}

OpenChains follow_curves(std::span<const Wedge> wedges,
                         const std::function<CurvePoint(std::uint64_t)>& point_of,
                         const std::function<void(std::span<const CurveStep>, Scale)>& visit) {
  OpenChains found;
  // Each wedge ends at two edges, each edge at two wedges.
  found.totals.edges = static_cast<std::uint64_t>(std::ranges::count(wedges, Scale::kFine, &Wedge::scale));
  std::vector<LocalIndex> chain_of(wedges.size()), open;
  LocalIndex chains = 0;
  std::vector<CurveStep> curve;
  follow_wedges(wedges, partners_of(wedges), [&](const WedgeChain& chain) {
    const LocalIndex number = chains++;
    for (const LocalIndex w : chain.wedges) chain_of[w] = number;
    const Scale scale = wedges[chain.wedges.front()].scale;
    if (chain.is_closed) {
      curve.clear();
      for (const LocalIndex w : chain.wedges) curve.push_back({wedges[w].id, w});
      return visit(curve, scale);
    }
    const auto end = [&](LocalIndex w, std::size_t side) {
      return ChainEnd{wedges[w].row, side == 0 ? wedges[w].from : wedges[w].to};
    };
    open.push_back(number);
    found.chains.push_back(
        {found.points.size(),
         chain.wedges.size(),
         scale,
         {end(chain.wedges.front(), chain.first_side), end(chain.wedges.back(), chain.last_side)}});
    for (const LocalIndex w : chain.wedges) found.points.push_back(point_of(w));
  });
  number_components(connect_chains(wedges, chain_of, chains), open, found);
  return found;
}

TileLoops TileLoops::read(const TileOutputs& outputs, TileIndex tile) {
  return {outputs.read(kLoops, tile), outputs.read(kLoopPoints, tile)};
}

void TileLoops::emit(TileOutput& output) && {
  output.add(kLoops, std::move(loops));
  output.add(kLoopPoints, std::move(points));
}

std::uint64_t TileLoops::bytes(const TileOutputs& outputs, TileIndex tile) {
  return outputs.count(kLoops, tile) * sizeof(Entry) + outputs.count(kLoopPoints, tile) * sizeof(LoopPoint);
}

}  // namespace lacuna::tangential
