// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/order_edges.hpp"

#include "engine/evaluate/evaluate.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace lacuna::paper {
namespace {

// Weights are whole steps, so they can be sorted digit by digit. Most are below 3: three digits.
constexpr int kDigitBits = 9;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;

std::uint64_t steps(const WeightedEdge& edge) {
  return static_cast<std::uint64_t>(edge.weight * (1 / kProbabilityStep));
}

// Sorts ascending by one digit of the weight; equal weights keep their order.
void sort_by_digit(std::span<const WeightedEdge> from, std::span<WeightedEdge> to, int shift) {
  const auto digit = [&](const WeightedEdge& edge) { return steps(edge) >> shift & (kDigits - 1); };
  std::array<std::size_t, kDigits> next{};
  for (const WeightedEdge& edge : from) ++next[digit(edge)];
  std::size_t begin = 0;
  for (std::size_t& place : next) begin += std::exchange(place, begin);
  for (const WeightedEdge& edge : from) to[next[digit(edge)]++] = edge;
}

}  // namespace

void order_edges(std::vector<WeightedEdge>& edges, std::span<const PointId> ids) {
  std::uint64_t most = 0;
  for (const WeightedEdge& edge : edges) most = std::max(most, steps(edge));
  std::vector<WeightedEdge> other(edges.size());
  for (int shift = 0; most >> shift != 0; shift += kDigitBits) {
    sort_by_digit(edges, other, shift);
    edges.swap(other);
  }
  const auto by_ids = [&](const WeightedEdge& x, const WeightedEdge& y) {
    return std::minmax(ids[x.a], ids[x.b]) < std::minmax(ids[y.a], ids[y.b]);
  };
  for (auto begin = edges.begin(), end = begin; begin != edges.end(); begin = end) {
    while (end != edges.end() && end->weight == begin->weight) ++end;
    if (end - begin > 1) std::sort(begin, end, by_ids);
  }
}

}  // namespace lacuna::paper
