// SPDX-License-Identifier: Apache-2.0
// The vocabulary of the tests of io/: files drawn as bytes, rows as numbers.
#pragma once

#include "io/read/formats.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "tests/support/drawn_files.hpp"

namespace lacuna::test {

// Bytes of values, in the given order.
class Bytes {
 public:
  explicit Bytes(std::endian order = std::endian::little) : order_(order) {}

  template <class T>
  Bytes& operator<<(T value) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (order_ != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    text_.append(bytes.data(), bytes.size());
    return *this;
  }

  const std::string& str() const { return text_; }

 private:
  std::endian order_;
  std::string text_;
};

struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;

  // Which column has the name; throws if none has.
  std::size_t place(const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw std::runtime_error("no column " + name);
    return static_cast<std::size_t>(found - names.begin());
  }
  std::vector<double> column(const std::string& name) const {
    std::vector<double> values;
    for (const auto& row : rows) values.push_back(row.at(place(name)));
    return values;
  }
};

inline double value_of(const std::byte* row, const io::Property& property) {
  double value = 0;
  io::copy_column({.data = row + property.offset, .stride = 0, .type = property.type},
                  {.data = reinterpret_cast<std::byte*>(&value), .stride = 0, .type = io::Scalar::kFloat64},
                  1);
  return value;
}

inline Table read_table(const fs::path& file, std::size_t max_rows = 1000,
                        const io::ReadOptions& options = {}) {
  const auto reader = io::open_scan(file, options);
  const io::RowLayout& layout = reader->layout();
  Table table;
  for (const io::Property& property : layout.properties) table.names.push_back(property.name);
  io::RowBatch batch;
  while (reader->next(batch, max_rows)) {
    for (std::size_t row = 0; row < batch.count; ++row) {
      std::vector<double>& values = table.rows.emplace_back();
      const std::byte* const bytes = batch.bytes.data() + row * layout.stride;
      for (const io::Property& property : layout.properties) values.push_back(value_of(bytes, property));
    }
  }
  return table;
}

// NaN is NaN.
inline bool same_numbers(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// What is found while all rows of a file are read.
inline auto findings_of(const fs::path& file) {
  const auto reader = io::open_scan(file, {});
  for (io::RowBatch batch; reader->next(batch, 1);) continue;
  return reader->findings();
}

inline std::string read_error(const fs::path& file, const io::ReadOptions& options = {}) {
  return error_of([&] { read_table(file, 1000, options); });
}

// What is wrong, and a part of the reason that the user is given: the place, and what is wrong there.
struct Wrong {
  std::string content;
  std::string part;
};

// refuse(content): the reason, one line.
template <class Refuse>
void check_reasons(const std::vector<Wrong>& cases, const Refuse& refuse) {
  for (const Wrong& wrong : cases) {
    INFO(wrong.content.substr(0, 300));
    const std::string reason = refuse(wrong.content);
    CHECK_THAT(reason, Contains(wrong.part));
    CHECK(reason.find('\n') == reason.npos);
  }
}

// Files of this name, each with what is behind `before`, that no reader takes.
inline void check_refused(const std::string& name, const std::vector<Wrong>& cases,
                          const std::string& before = "") {
  const ScratchFolder folder;
  check_reasons(cases, [&](const std::string& content) {
    const std::string reason = read_error(folder.write(name, before + content));
    CHECK_THAT(reason, Contains(name + ": "));
    return reason;
  });
}

// Requires that a file has these rows, whatever the batches that it is read in. row_at(i): row i.
inline void check_rows(const fs::path& file, std::size_t rows,
                       const std::function<std::vector<double>(double)>& row_at) {
  for (const std::size_t max_rows : {1u, 999u, 65'536u, 1'000'000u}) {
    const Table table = read_table(file, max_rows);
    REQUIRE(table.rows.size() == rows);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < rows; ++i) wrong += table.rows[i] != row_at(static_cast<double>(i));
    CHECK(wrong == 0);
  }
}

}  // namespace lacuna::test
