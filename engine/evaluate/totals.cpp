// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/totals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lacuna {
namespace {

// Returns a power of two so small that no edge is lost: 2^-60 of the scan's extent.
double length_unit(double extent) {
  return extent > 0 ? std::ldexp(1.0, std::ilogb(extent) - 60) : 1.0;
}

// The sums of a tile, as plain data.
struct TileSums {
  std::uint64_t points, neighbours, candidates, undefined_normals, normals_off;
  ProbabilityBins probabilities;
  std::uint64_t edge_length_low;
  std::int64_t edge_length_high;
};
struct DistanceBin {
  std::uint64_t bin, count, half_discs;
};

constexpr RecordStream<TileSums> kSums{"sums"};
constexpr RecordStream<DistanceBin> kDistances{"distances"};

TileSums sums_of(const Totals& totals) {
  return {.points = totals.points,
          .neighbours = totals.neighbours,
          .candidates = totals.candidates,
          .undefined_normals = totals.undefined_normals,
          .normals_off = totals.normals_off,
          .probabilities = totals.probabilities,
          .edge_length_low = static_cast<std::uint64_t>(totals.edge_length),
          .edge_length_high = static_cast<std::int64_t>(totals.edge_length >> 64)};
}

std::vector<DistanceBin> bins_of(const Totals& totals) {
  std::vector<DistanceBin> bins;
  for (const auto& [bin, count] : totals.distances.counts)
    bins.push_back({bin, count, totals.half_discs.counts.at(bin)});
  return bins;
}

void add(const std::vector<TileSums>& of_tiles, const std::vector<DistanceBin>& distances, Totals& totals) {
  for (const TileSums& sums : of_tiles) {
    totals.points += sums.points;
    totals.neighbours += sums.neighbours;
    totals.candidates += sums.candidates;
    totals.undefined_normals += sums.undefined_normals;
    totals.normals_off += sums.normals_off;
    totals.edge_length += (Int128{sums.edge_length_high} << 64) + sums.edge_length_low;
    for (std::size_t bin = 0; bin < kProbabilityBins; ++bin)
      totals.probabilities[bin] += sums.probabilities[bin];
  }
  for (const DistanceBin& of : distances) {
    const auto bin = static_cast<std::uint32_t>(of.bin);
    totals.distances.counts[bin] += of.count;
    totals.half_discs.counts[bin] += of.half_discs;
  }
}

}  // namespace

Totals::Totals(double extent) : length_unit(lacuna::length_unit(extent)) {}

double Totals::mean_neighbours() const {
  return points == 0 ? 0 : static_cast<double>(neighbours) / static_cast<double>(points);
}

double Totals::mean_edge_length() const {
  if (neighbours == 0) return 0;
  return static_cast<double>(edge_length) / static_cast<double>(neighbours) * length_unit;
}

double Totals::surface_area(double far) const {
  return std::numbers::pi * 2.25 * half_discs.sum_of_squares(far) / 2 / (mean_neighbours() + 2.5);
}

Totals sum_up(std::span<const Evaluation> evaluations, const Neighbourhoods& neighbourhoods, double threshold,
              double extent, std::vector<LocalIndex>& candidates) {
  constexpr double kAtBoundary = 0.5;  // Pi of a point whose neighbours lie to one side of it
  Totals totals(extent);
  totals.points = evaluations.size();
  totals.neighbours = neighbourhoods.indices.size();
  std::vector<std::uint32_t> distances(LengthBins::bin_of(std::numeric_limits<double>::infinity()));
  std::vector<std::uint32_t> half_discs(distances.size());
  for (LocalIndex p = 0; p < evaluations.size(); ++p) {
    const Evaluation& e = evaluations[p];
    if (e.probability > threshold) candidates.push_back(p);
    ++totals.probabilities[std::min(kProbabilityBins - 1,
                                    static_cast<std::size_t>(e.probability * kProbabilityBins))];
    totals.undefined_normals += !e.normal.allFinite();
    totals.normals_off += e.is_normal_off;
    if (e.mean_distance > 0 && std::isfinite(e.mean_distance)) {
      const std::uint32_t bin = LengthBins::bin_of(e.mean_distance);
      ++distances[bin];
      half_discs[bin] += e.probability > kAtBoundary ? 1 : 2;
    }
    const double length =
        e.mean_distance * static_cast<double>(neighbourhoods[p].size()) / totals.length_unit;
    constexpr double kShort = 0x1p62;  // what fits is converted in one instruction
    totals.edge_length += length < kShort ? static_cast<std::int64_t>(length) : static_cast<Int128>(length);
  }
  totals.candidates = candidates.size();
  for (std::uint32_t bin = 0; bin < distances.size(); ++bin) {
    if (distances[bin] == 0) continue;
    totals.distances.counts[bin] = distances[bin];
    totals.half_discs.counts[bin] = half_discs[bin];
  }
  return totals;
}

void emit_totals(const Totals& sums, TileOutput& output) {
  output.add(kSums, {sums_of(sums)});
  output.add(kDistances, bins_of(sums));
}

Totals read_totals(const TileOutputs& outputs, const Tiling& tiling, double extent) {
  Totals totals(extent);
  for (TileIndex tile = 0; tile < tiling.tiles.size(); ++tile)
    add(outputs.read(kSums, tile), outputs.read(kDistances, tile), totals);
  return totals;
}

void write_totals(const Totals& totals, PartWriter& part) {
  part.add_one(kSums.name, sums_of(totals));
  part.add(kDistances.name, bins_of(totals));
}

Totals read_totals(const PartReader& part, double extent) {
  Totals totals(extent);
  add(part.records<TileSums>(kSums.name), part.records<DistanceBin>(kDistances.name), totals);
  return totals;
}

}  // namespace lacuna
