#include "engine/core/sorting_network.hpp"

#include "engine/core/lanes.hpp"

#include <type_traits>
#include <utility>

namespace lacuna::LACUNA_LANES {
namespace {

// As many columns of a row as fit.
LACUNA_INLINE Lanes columns(const Eight& row, std::size_t first) {
  return load(row.at + first);
}
LACUNA_INLINE SinglesOfEight columns(const EightSingles& row, std::size_t first) {
  return load_as<SinglesOfEight>(row.at + first);
}
LACUNA_INLINE Singles columns(const Sixteen& row, std::size_t first) {
  return load(row.at + first);
}

template <class Row>
using RegisterOf = decltype(columns(Row{}, 0));

template <class Row>
LACUNA_INLINE void set_columns(Row& row, std::size_t first, RegisterOf<Row> numbers) {
  store(row.at + first, numbers);
}

template <class Row>
LACUNA_INLINE RegisterOf<Row> infinite_columns() {
  return RegisterOf<Row>{} + static_cast<std::remove_extent_t<decltype(Row::at)>>(__builtin_inf());
}

consteval std::size_t count_comparisons(std::size_t rows) {
  std::size_t count = 0;
  for_each_comparison(rows, [&](Comparison) { ++count; });
  return count;
}

template <std::size_t kRows>
struct Comparisons {
  Comparison at[count_comparisons(kRows)];
};

template <std::size_t kRows>
consteval Comparisons<kRows> all_comparisons() {
  Comparisons<kRows> all{};
  std::size_t count = 0;
  for_each_comparison(kRows, [&](Comparison c) { all.at[count++] = c; });
  return all;
}

template <class Register>
LACUNA_INLINE void put_in_order(Register& low, Register& high) {
  const Register a = low, b = high;
  low = smaller(a, b);
  high = larger(a, b);
}

// kRows rows, or one less. All comparisons are written out, so that the rows stay in registers.
template <std::size_t kRows, class Row>
void sort_few(Row* rows, std::size_t count, std::size_t first) {
  constexpr Comparisons<kRows> kAll = all_comparisons<kRows>();
  constexpr std::size_t kLast = kRows - 1;
  RegisterOf<Row> row[kRows];
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    ((row[i] = columns(rows[i], first)), ...);
  }
  (std::make_index_sequence<kLast>{});
  row[kLast] = count == kRows ? columns(rows[kLast], first) : infinite_columns<Row>();
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (put_in_order(row[kAll.at[i].low], row[kAll.at[i].high]), ...);
  }
  (std::make_index_sequence<count_comparisons(kRows)>{});
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (set_columns(rows[i], first, row[i]), ...);
  }
  (std::make_index_sequence<kLast>{});
  if (count == kRows) set_columns(rows[kLast], first, row[kLast]);
}

template <class Row>
void sort_many(Row* rows, std::size_t count, std::size_t wanted, std::size_t first) {
  const SortingNetwork network = sorting_network(count, wanted);
  for (std::size_t i = 0; i < network.count; ++i) {
    const Comparison c = network.comparisons[i];
    RegisterOf<Row> low = columns(rows[c.low], first), high = columns(rows[c.high], first);
    put_in_order(low, high);
    set_columns(rows[c.low], first, low);
    set_columns(rows[c.high], first, high);
  }
}

template <class Row, std::size_t... i>
void sort_by_count(Row* rows, std::size_t count, std::size_t first, std::index_sequence<i...>) {
  using Sort = void(Row*, std::size_t, std::size_t);
  static constexpr Sort* kSorts[] = {sort_few<2 * i + 2, Row>...};
  kSorts[(count - 1) / 2](rows, count, first);
}

// As many columns as a register holds, from `first` on.
template <class Row>
void sort_some(Row* rows, std::size_t count, std::size_t wanted, std::size_t first) {
  if (count < 2) return;
  if (count <= kRowsInRegisters) {
    sort_by_count(rows, count, first, std::make_index_sequence<kRowsInRegisters / 2>{});
  } else {
    sort_many(rows, count, wanted, first);
  }
}

}  // namespace

void sort_columns(EightSingles* rows, std::size_t count, std::size_t first) {
  sort_some(rows, count, count, first);
}

void sort_rows(Eight* rows, std::size_t count, std::size_t wanted) {
  for (std::size_t first = 0; first < kEight; first += kLanes) sort_some(rows, count, wanted, first);
}

void sort_single_rows(Sixteen* rows, std::size_t count, std::size_t wanted) {
  for (std::size_t first = 0; first < kSixteen; first += kSingles) sort_some(rows, count, wanted, first);
}

}  // namespace lacuna::LACUNA_LANES
