// SPDX-License-Identifier: Apache-2.0
#include "tests/io/broken_files.hpp"

namespace lacuna::test {
namespace {

std::string npy(const std::string& type, const std::string& shape, bool is_fortran, const Bytes& values) {
  std::string header = "{'descr': " + type + ", 'fortran_order': " + (is_fortran ? "True" : "False") +
                       ", 'shape': " + shape + ", }";
  header += std::string(64 - (10 + header.size() + 1) % 64, ' ') + "\n";
  Bytes length;
  length << static_cast<std::uint16_t>(header.size());
  return std::string("\x93NUMPY\1\0", 8) + length.str() + header + values.str();
}

std::vector<WholeFile> npy_files() {
  const std::string plain = npy("'<f4'", "(2, 3)", false, Bytes() << 1.f << 2.f << 3.f << 4.f << 5.f << 6.f);
  return {{.name = "a.npy", .bytes = plain}};
}

}  // namespace

TEST_CASE("arrays of NumPy have the rows that they were made of", "[io]") {
  using NpyRows = std::vector<std::vector<double>>;
  const ScratchFolder folder;
  const auto rows = [&](const std::string& bytes) {
    return read_table(folder.write("a.npy", bytes), 1).rows;
  };
  const NpyRows expected = {{1, 2, 3}, {4, 5, 6}};
  CHECK(rows(npy("'<f8'", "(2, 3)", false, Bytes() << 1. << 2. << 3. << 4. << 5. << 6.)) == expected);
  CHECK(rows(npy("'<f4'", "(2, 3)", true, Bytes() << 1.f << 4.f << 2.f << 5.f << 3.f << 6.f)) == expected);
  CHECK(rows(npy("'>f4'", "(2, 3)", false,
                 Bytes(std::endian::big) << 1.f << 2.f << 3.f << 4.f << 5.f << 6.f)) == expected);
  const auto long_of = [](std::int64_t value) { return value; };
  CHECK(rows(npy("'<i8'", "(1, 3)", false, Bytes() << long_of(-1) << long_of(2) << long_of(3))) ==
        NpyRows{{-1, 2, 3}});
  const Table named = read_table(
      folder.write("b.npy", npy("[('t', '|u1'), ('', '|V3'), ('Easting', '<f8'), ('Northing', '<f8'), "
                                "('Height', '<f4')]",
                                "(1,)", false,
                                Bytes() << std::uint8_t{9} << std::uint8_t{0} << std::uint8_t{0}
                                        << std::uint8_t{0} << 1.5 << 2.5 << 3.5f)));
  CHECK(named.names == std::vector<std::string>{"t", "x", "y", "z"});
  CHECK(named.rows == NpyRows{{9, 1.5, 2.5, 3.5}});
}

TEST_CASE("an array of NumPy that has no points is an error that says so", "[io]") {
  const Bytes three = Bytes() << 1.f << 2.f << 3.f;
  check_refused("a.npy",
                {{npy("'<f4'", "(2, 2)", false, Bytes() << 1.f << 2.f << 3.f << 4.f), "an array of 2 x 2"},
                 {npy("'|O'", "(1, 3)", false, three), "values of the type '|O'"},
                 {npy("'<f4'", "(2, 3)", false, three), "too early for the 2 rows"}});
}

TEST_CASE("a matrix of depths in NumPy is no list of points, in either order", "[io]") {
  Bytes depths;  // a slope, 0 where a camera saw nothing
  for (int i = 0; i < 40 * 30; ++i)
    depths << static_cast<std::uint16_t>(i % 7 == 0 ? 0 : 2000 + 3 * (i / 30) + 5 * (i % 30));
  check_refused("a.npy", {{npy("'<u2'", "(40, 30)", false, depths),
                           "byte 10: a matrix of 40 x 30, as of heights or depths"},
                          {npy("'<u2'", "(30, 40)", true, depths), "a matrix of 30 x 40"}});
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.npy", npy("'<u2'", "(10, 40, 3)", false, depths))).rows.size() == 400);
}

TEST_CASE("broken arrays of NumPy give one error or whole rows", "[io]") {
  check_broken_files(npy_files(), 9);
}

}  // namespace lacuna::test
