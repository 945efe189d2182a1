// SPDX-License-Identifier: Apache-2.0
// Records of some rows of a column, read and written in runs of rows that are near each other.
#pragma once

#include "engine/model/ids.hpp"
#include "engine/store/column.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

// Calls visit(begin, end) for runs of `rows`, which ascend. Rows between runs are not touched. Most were
// never written, and to read them would fill the system's cache with zeros.
template <class Visit>
void for_each_run(std::span<const Row> rows, Visit&& visit) {
  constexpr std::uint64_t kNear = 64;
  for (std::size_t begin = 0, end; begin < rows.size(); begin = end) {
    for (end = begin + 1; end < rows.size() && value(rows[end]) <= value(rows[end - 1]) + kNear;) ++end;
    visit(begin, end);
  }
}

// Returns the records from the first to the last of the rows of one run.
template <class Record>
std::vector<Record> read_run(const Column<Record>& column, std::span<const Row> rows) {
  return column.read(value(rows.front()), value(rows.back()) + 1 - value(rows.front()));
}

// Returns the records of rows that ascend and were written.
template <class Record>
std::vector<Record> read_rows(const Column<Record>& column, std::span<const Row> rows) {
  std::vector<Record> records(rows.size());
  for_each_run(rows, [&](std::size_t begin, std::size_t end) {
    const std::uint64_t first = value(rows[begin]);
    const std::vector<Record> run = read_run(column, rows.subspan(begin, end - begin));
    for (std::size_t i = begin; i < end; ++i) records[i] = run[value(rows[i]) - first];
  });
  return records;
}

// Writes the records of rows that ascend. Rows between the rows of one run get zeros.
template <class Record>
void write_rows(Column<Record>& column, std::span<const Row> rows, std::span<const Record> records) {
  for_each_run(rows, [&](std::size_t begin, std::size_t end) {
    const std::uint64_t first = value(rows[begin]);
    std::vector<Record> run(value(rows[end - 1]) + 1 - first);
    for (std::size_t i = begin; i < end; ++i) run[value(rows[i]) - first] = records[i];
    column.write(first, run);
  });
}

// Replaces the records of rows that ascend and were written. No other thread writes rows between them.
template <class Record>
void replace_rows(Column<Record>& column, std::span<const Row> rows, std::span<const Record> records) {
  for_each_run(rows, [&](std::size_t begin, std::size_t end) {
    const std::uint64_t first = value(rows[begin]);
    std::vector<Record> run = read_run(column, rows.subspan(begin, end - begin));
    for (std::size_t i = begin; i < end; ++i) run[value(rows[i]) - first] = records[i];
    column.write(first, run);
  });
}

}  // namespace lacuna
