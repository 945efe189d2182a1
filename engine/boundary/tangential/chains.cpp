#include "engine/boundary/tangential/chains.hpp"

#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>
#include <utility>

namespace lacuna {
namespace {

// An end by its boundary edge, which exactly one other end shares. Ends are numbered: those of chain c are 2 c and
// 2 c + 1.
struct NumberedEnd {
  Row low, high;
  LocalIndex end;

  NumberedEnd(const ChainEnd& e, LocalIndex end)
      : low(std::min(e.own, e.foreign)), high(std::max(e.own, e.foreign)), end(end) {}
  NumberedEnd() = default;
  friend bool operator<(const NumberedEnd& a, const NumberedEnd& b) {
    return std::tie(a.low, a.high, a.end) < std::tie(b.low, b.high, b.end);
  }
};

// Calls add(end) for both ends of a chain.
template <class Add>
void add_ends(const OpenChain& chain, LocalIndex number, Add&& add) {
  for (const LocalIndex side : {0, 1}) add(NumberedEnd(chain.ends[side], 2 * number + side));
}

// Fills in the end that shares the boundary edge of each end, from all ends in ascending order.
class Partners {
 public:
  explicit Partners(std::span<LocalIndex> partners) : partners_(partners) {}

  void add(const NumberedEnd& end) {
    if (is_second_) {
      assert(before_.low == end.low && before_.high == end.high);
      partners_[before_.end] = end.end;
      partners_[end.end] = before_.end;
    }
    is_second_ = !is_second_;
    before_ = end;
  }

 private:
  std::span<LocalIndex> partners_;
  NumberedEnd before_;
  bool is_second_ = false;
};

void append_points(const OpenChain& chain, bool forwards, const Column<CurvePoint>& points,
                   std::vector<CurvePoint>& curve) {
  const auto begin = static_cast<std::ptrdiff_t>(curve.size());
  curve.resize(curve.size() + chain.count);
  points.read(chain.first, std::span(curve).last(chain.count));
  if (!forwards) std::reverse(curve.begin() + begin, curve.end());
}

// `is_done`: by chain, zeros.
void follow_chains(std::span<const OpenChain> chains, std::span<const LocalIndex> partners,
                   std::span<std::uint8_t> is_done, const Column<CurvePoint>& points, Scratch* scratch,
                   const std::function<void(std::vector<CurvePoint>&)>& visit) {
  std::vector<CurvePoint> curve;
  for (LocalIndex start = 0; start < chains.size(); ++start) {
    if (is_done[start]) continue;
    curve.clear();
    for (LocalIndex entered = 2 * start; !is_done[entered / 2]; entered = partners[entered ^ 1]) {
      if (scratch != nullptr) scratch->trim();
      is_done[entered / 2] = 1;
      append_points(chains[entered / 2], entered % 2 == 0, points, curve);
    }
    visit(curve);
  }
}

}  // namespace

void close_chains(std::span<const OpenChain> chains, const Column<CurvePoint>& points,
                  const std::function<void(std::vector<CurvePoint>&)>& visit) {
  std::vector<NumberedEnd> ends;
  ends.reserve(2 * chains.size());
  for (LocalIndex c = 0; c < chains.size(); ++c)
    add_ends(chains[c], c, [&](const NumberedEnd& end) { ends.push_back(end); });
  std::sort(ends.begin(), ends.end());
  std::vector<LocalIndex> partners(ends.size());
  Partners join(partners);
  for (const NumberedEnd& end : ends) join.add(end);
  std::vector<std::uint8_t> is_done(chains.size());
  follow_chains(chains, partners, is_done, points, nullptr, visit);
}

void close_many_chains(const Stitch<OpenChain>::ForEachRecord& for_each_chain, std::uint64_t count,
                       const Column<CurvePoint>& points, const Job& job,
                       const std::function<void(std::vector<CurvePoint>&)>& visit) {
  Scratch scratch(job.workspace, job.memory.global / 4);
  SortedRuns<NumberedEnd> ends(job.file("chain-ends"), job.memory.global / 4);
  const std::span<OpenChain> chains = scratch.array<OpenChain>(count);
  LocalIndex number = 0;
  for_each_chain([&](const OpenChain& chain) {
    scratch.trim();
    chains[number] = chain;
    add_ends(chain, number++, [&](const NumberedEnd& end) { ends.add(end); });
  });
  const std::span<LocalIndex> partners = scratch.array<LocalIndex>(2 * count);
  Partners join(partners);
  ends.for_each([&](const NumberedEnd& end) {
    scratch.trim();
    join.add(end);
  });
  follow_chains(chains, partners, scratch.array<std::uint8_t>(count), points, &scratch, visit);
}

}  // namespace lacuna
