// Sorting rows of numbers column by column, without a branch: the same comparisons whatever the numbers.
#if defined(LACUNA_SIMD_SORT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_SIMD_SORT_INL
#undef LACUNA_SIMD_SORT_INL
#else
#define LACUNA_SIMD_SORT_INL
#endif

#include "engine/simd/batch.hpp"
#include "engine/simd/sort.hpp"
#include "engine/simd/vector-inl.hpp"

#include <limits>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

// visit(low, high): the comparisons after which `rows` rows are in ascending order, if each puts the smaller
// number into row `low`. Batcher's odd-even merge exchange (Knuth, The Art of Computer Programming 3, 5.2.2,
// algorithm M).
template <class Visit>
constexpr HWY_INLINE void for_each_comparison(std::size_t rows, Visit&& visit) {
  std::size_t top = 1;  // half of the rows, rounded up to a power of two
  while (2 * top < rows) top *= 2;
  for (std::size_t p = top; p > 0; p /= 2) {
    std::size_t q = top, r = 0, d = p;
    for (;;) {
      for (std::size_t i = 0; i + d < rows; ++i) {
        if ((i & p) == r) visit(i, i + d);
      }
      if (q == p) break;
      d = q - p;
      q /= 2;
      r = p;
    }
  }
}

consteval std::size_t count_comparisons(std::size_t rows) {
  std::size_t count = 0;
  for_each_comparison(rows, [&](std::size_t, std::size_t) { ++count; });
  return count;
}

template <std::size_t kRows>
struct Comparisons {
  struct {
    std::size_t low, high;
  } at[count_comparisons(kRows)];

  consteval Comparisons() : at{} {
    std::size_t count = 0;
    for_each_comparison(kRows, [&](std::size_t low, std::size_t high) { at[count++] = {low, high}; });
  }
};

template <class V>
HWY_INLINE void put_in_order(V& low, V& high) {
  const V a = low, b = high;
  low = hn::Min(a, b);
  high = hn::Max(a, b);
}

// kRows rows, or one less, of as many columns as a vector holds. All comparisons are written out, so that the
// rows stay in registers.
template <std::size_t kRows, class D, class Row>
void sort_in_registers(D d, Row* rows, std::size_t count, std::size_t column) {
  static constexpr Comparisons<kRows> kAll;
  constexpr std::size_t kLast = kRows - 1;
  using V = hn::Vec<D>;
  V row[kRows];
  [&]<std::size_t... i>(std::index_sequence<i...>) HWY_ATTR {
    ((row[i] = hn::Load(d, rows[i].at + column)), ...);
  }
  (std::make_index_sequence<kLast>{});
  row[kLast] =
      count == kRows ? hn::Load(d, rows[kLast].at + column) : all<V>(std::numeric_limits<double>::infinity());
  [&]<std::size_t... i>(std::index_sequence<i...>) HWY_ATTR {
    (put_in_order(row[kAll.at[i].low], row[kAll.at[i].high]), ...);
  }
  (std::make_index_sequence<count_comparisons(kRows)>{});
  [&]<std::size_t... i>(std::index_sequence<i...>) HWY_ATTR {
    (hn::Store(row[i], d, rows[i].at + column), ...);
  }
  (std::make_index_sequence<kLast>{});
  if (count == kRows) hn::Store(row[kLast], d, rows[kLast].at + column);
}

template <class D, class Row, std::size_t... i>
HWY_INLINE void sort_in_registers(D d, Row* rows, std::size_t count, std::size_t column,
                                  std::index_sequence<i...>) {
  using Sort = void(D, Row*, std::size_t, std::size_t);
  static constexpr Sort* kSorts[] = {sort_in_registers<2 * i + 2, D, Row>...};
  kSorts[(count - 1) / 2](d, rows, count, column);
}

template <class D, class Row>
void sort_in_memory(D d, Row* rows, std::size_t count, std::size_t column) {
  for_each_comparison(count, [&](std::size_t i, std::size_t k) HWY_ATTR {
    auto low = hn::Load(d, rows[i].at + column), high = hn::Load(d, rows[k].at + column);
    put_in_order(low, high);
    hn::Store(low, d, rows[i].at + column);
    hn::Store(high, d, rows[k].at + column);
  });
}

// As many columns as a vector holds. Not for NaN.
template <class D, class Row>
HWY_INLINE void sort_columns(D d, Row* rows, std::size_t count, std::size_t column) {
  if (count < 2) return;
  if (count <= kRowsInRegisters) {
    sort_in_registers(d, rows, count, column, std::make_index_sequence<kRowsInRegisters / 2>{});
  } else {
    sort_in_memory(d, rows, count, column);
  }
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
