#include "engine/stages/nearest_lists.hpp"

#include "engine/core/lanes.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

// visit(place, neighbours): a line, by registers; `place` of the first of them.
template <class Visit>
LACUNA_INLINE void for_each_register(const ListLine& line, Visit&& visit) {
  for (std::size_t place = 0; place < kListLine; place += kSingles) {
    visit(place, load_as<SingleBits>(line.points + place));
  }
}

// Which places of the line hold such a point.
template <class IsChosen>
LACUNA_INLINE std::uint32_t places(const ListLine& line, IsChosen&& is_chosen) {
  std::uint32_t chosen = 0;
  for_each_register(line, [&](std::size_t place, SingleBits points) {
    chosen |= chosen_lanes(reinterpret_cast<SingleBits>(is_chosen(points))) << place;
  });
  return chosen;
}

// `stride`: the lists', best known when this is compiled.
LACUNA_INLINE void find_mutual_in(const NearestLists& lists, std::size_t stride, std::uint32_t first,
                                  std::uint32_t last) {
  for (std::uint32_t p = first; p < last; ++p) {
    const std::size_t begin = p * stride;
    for (std::size_t own = begin; own < begin + stride; ++own) {
      const ListLine& line = lists.lines[own];
      std::uint32_t mutual = 0;
      for (std::uint32_t left = places(line, [&](SingleBits q) { return q < p; }); left != 0;
           left &= left - 1) {
        const std::size_t q = line.points[__builtin_ctz(left)];
        std::uint32_t some = 0;
        for (std::size_t other = q * stride; other < q * stride + stride; ++other) {
          const std::uint32_t at = places(lists.lines[other], [&](SingleBits points) { return points == p; });
          lists.mutual[other] |= static_cast<std::uint16_t>(at);
          some |= at;
        }
        mutual |= left & -left & -std::uint32_t{some != 0};  // without a branch: nobody can foretell it
      }
      lists.mutual[own] = static_cast<std::uint16_t>(mutual);
    }
  }
}

}  // namespace

void find_mutual(const NearestLists& lists, std::uint32_t first, std::uint32_t last) {
  if (lists.stride == 1) {
    find_mutual_in(lists, 1, first, last);
  } else {
    find_mutual_in(lists, lists.stride, first, last);
  }
}

std::size_t find_one_sided(const NearestLists& lists, std::uint32_t first, std::uint32_t last,
                           std::uint32_t owned, const EdgeList& edges) {
  std::size_t found = 0;
  for (std::uint32_t p = first; p < last; ++p) {
    const SingleBits all = SingleBits{} + p;
    const std::size_t begin = p * lists.stride;
    for (std::size_t line = begin; line < begin + lists.stride; ++line) {
      for_each_register(lists.lines[line], [&](std::size_t place, SingleBits q) {
        const std::uint32_t there = chosen_lanes(reinterpret_cast<SingleBits>(q < owned));
        const Choice choice(there & ~(std::uint32_t{lists.mutual[line]} >> place));
        choice.pack(edges.q + found, q);
        store(edges.p + found, all);
        found += choice.count();
      });
    }
  }
  return found;
}

}  // namespace lacuna::LACUNA_LANES
