// SPDX-License-Identifier: Apache-2.0
// Several LAS files as one points.las: fields and extra bytes that not all of them have, or not in one form.
#include "tests/io/results/points_las_support.hpp"

#include <limits>

namespace lacuna::test {
using namespace io;

namespace {

// A descriptor with a "no data" value, a range of 1 to 2 and a description.
template <class T>
std::string full_descriptor(const std::string& name, std::uint8_t type, T no_data) {
  std::string bytes = las_extra_descriptor(name, type, 1 + 2 + 4);
  put(bytes, 40, no_data);
  put(bytes, 64, T{1});
  put(bytes, 88, T{2});
  std::memcpy(&bytes[160], "what it is", 10);
  return bytes;
}

// The descriptor of these extra bytes in points.las, whose first record has them.
std::string descriptor_of(const std::string& las, const std::string& name) {
  constexpr std::size_t kBytes = 192;
  for (std::size_t place = 375 + 54; place + kBytes <= at<std::uint32_t>(las, 96); place += kBytes) {
    if (las.substr(place + 4, 32) == name + std::string(32 - name.size(), '\0'))
      return las.substr(place, kBytes);
  }
  FAIL("no extra bytes of that name: " << name);
  return {};
}

// Format 1, with values of extra bytes behind the fields.
LasFile file_with(const std::vector<std::string>& descriptors, const std::string& values) {
  LasFile las = file_of(1, 4, values.size());
  std::string all;
  for (const std::string& one : descriptors) all += one;
  if (!all.empty()) las.records = {las_record("LASF_Spec", 4, all)};
  for (std::string& point : las.points) point.replace(28, values.size(), values);
  return las;
}

}  // namespace

TEST_CASE("a point of a file without the extra bytes of another one has no value there", "[io][results]") {
  const ScratchFolder folder;
  constexpr float kFloat = 0.5;
  constexpr double kDouble = 0.25;
  const std::string values = (Bytes() << kFloat << kDouble << std::int16_t{7} << std::uint32_t{8} << kFloat
                                      << kFloat << kFloat << kFloat << std::uint8_t{9})
                                 .str();
  const std::vector<std::string> descriptors = {
      las_extra_descriptor("float", 9),
      las_extra_descriptor("double", 10),
      full_descriptor<std::int64_t>("short", 4, -9999),
      las_extra_descriptor("long", 5),
      full_descriptor<double>("marked", 9, -1),  // NaN is "no data" to every reader, -1 is not
      las_extra_descriptor("vector", 29),
      las_extra_descriptor("raw", 0, 1)};
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const std::string missing =
      (Bytes() << kNone << std::numeric_limits<double>::quiet_NaN() << std::int16_t{-9999} << std::uint32_t{0}
               << kNone << kNone << kNone << kNone << std::uint8_t{0})
          .str();
  const ScanInput with = folder.write("with.las", file_with(descriptors, values).bytes());
  const ScanInput without = folder.write("without.las", file_of(1, 2).bytes());
  const ScanInput text = folder.write("text.xyz", "0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n");
  const std::vector<std::vector<ScanInput>> orders = {{with, without}, {without, with}, {text, with}};
  for (const auto& order : orders) {
    INFO(order.front().file);
    const std::string out = join(folder, order);
    for (std::size_t i = 0; i < 10; ++i) {
      const bool has_values = order[i / 5].file == with.file;
      CHECK((point_of(out, i, 28 + values.size()).substr(28) == (has_values ? values : missing)));
    }
  }
}

TEST_CASE("extra bytes of one name whose no data values differ become doubles, with NaN for no data",
          "[io][results]") {
  const ScratchFolder folder;
  const auto file = [&](const std::string& name, std::int16_t no_data, std::int16_t value) {
    LasFile las = file_with({full_descriptor<std::int64_t>("height", 4, no_data)}, (Bytes() << value).str());
    put(las.points[4], 28, no_data);
    return ScanInput(folder.write(name, las.bytes()));
  };
  const ScanInput a = file("a.las", -1, -9999), b = file("b.las", -9999, -1), same = file("same.las", -1, 5);
  const auto heights = [&] { return column(read_table(folder / "out" / "points.las"), "height"); };
  const double none = std::nan("");

  std::string out = join(folder, {a, b});
  CHECK(is_same(heights(), {-9999, -9999, -9999, -9999, none, -1, -1, -1, -1, none}));
  const std::string made = descriptor_of(out, "height");
  CHECK(at<std::uint8_t>(made, 2) == 10);
  CHECK(at<std::uint8_t>(made, 3) == 0);
  CHECK(made.substr(160, 11) == std::string("what it is\0", 11));

  // Equal ones stay; the range is no longer that of all points.
  out = join(folder, {a, same});
  CHECK(is_same(heights(), {-9999, -9999, -9999, -9999, -1, 5, 5, 5, 5, -1}));
  const std::string kept = descriptor_of(out, "height");
  CHECK(at<std::uint8_t>(kept, 2) == 4);
  CHECK(at<std::uint8_t>(kept, 3) == 1);
  CHECK(at<std::int64_t>(kept, 40) == -1);
  CHECK(kept.substr(64, 48) == std::string(48, '\0'));
}

TEST_CASE("points of overlap in a format with that class have the flag in one that has not",
          "[io][results]") {
  const ScratchFolder folder;
  LasFile old = file_of(1, 2);
  for (std::size_t i = 0; i < 5; ++i) put(old.points[i], 15, static_cast<std::uint8_t>(0xa0 | (10 + i)));
  const LasFile extended = file_of(6, 4);
  const std::string out =
      join(folder, {folder.write("old.las", old.bytes()), folder.write("new.las", extended.bytes())});
  constexpr unsigned kSyntheticAndWithheld = 5, kOverlap = 8;
  for (std::size_t i = 0; i < 5; ++i) {
    const std::string point = point_of(out, i, 30);
    CHECK(at<std::uint8_t>(point, 16) == (i == 2 ? 1 : 10 + i));
    CHECK((at<std::uint8_t>(point, 15) & 15u) == (kSyntheticAndWithheld | (i == 2 ? kOverlap : 0)));
  }
  CHECK(point_of(out, 5, 30).substr(12) == extended.points[0].substr(12));
}

TEST_CASE("the global encoding says how the joined times and coordinate systems are to be read",
          "[io][results]") {
  constexpr std::uint16_t kTime = 1, kText = 16, kOther = 8;
  const auto encoding = [&](int format, const std::vector<std::string>& records) {
    const ScratchFolder folder;
    LasFile a = file_of(format, 2);
    a.records = records;
    std::string first = a.bytes(), second = file_of(6, 4).bytes();
    put<std::uint16_t>(first, 6, kOther | (format == 1 ? kTime : 0));
    put<std::uint16_t>(second, 6, kTime | kText);
    const std::string out = join(folder, {folder.write("a.las", first), folder.write("b.las", second)});
    return at<std::uint16_t>(out, 6);
  };
  const std::string keys = las_record("LASF_Projection", 34735, std::string(8, '\0')),
                    text = las_record("LASF_Projection", 2112, "PROJCS[\"here\"]");
  CHECK(encoding(1, {}) == (kOther | kTime | kText));
  CHECK(encoding(0, {}) == (kOther | kTime | kText));  // the times are those of the second file
  CHECK(encoding(1, {keys}) == (kOther | kTime));      // nobody makes text of them
  CHECK(encoding(1, {keys, text}) == (kOther | kTime | kText));
}

}  // namespace lacuna::test
