// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/scan_pass.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {
namespace {

const std::string kRows =
    "x y z Classification ReturnNumber NumberOfReturns\n"
    "0 0 0 2 1 1\n"
    "1 1 1 2 1 2\n"
    "2 2 2 6 2 2\n"
    "3 3 3 6 1 1\n"
    "4 4 4 1 2 3\n"
    "nan 5 5 2 1 1\n";

struct Filtered {
  std::vector<int> kept;  // rows with a finite position
  FilteredOut out;
};

Filtered read_filtered(const std::vector<ScanInput>& inputs, const InputConfig& config) {
  const ScanFiles scan(inputs, config);
  ScanPass pass(scan);
  Filtered filtered;
  for (int time = 0; time < 2; ++time) {  // counts are of one pass
    filtered.kept.clear();
    pass.rewind();
    for (PointBatch batch; pass.next(batch);) {
      for (std::size_t i = 0; i < batch.size(); ++i)
        if (batch.positions[i].allFinite()) filtered.kept.push_back(static_cast<int>(value(batch.id(i))));
    }
  }
  if (filtered.kept.empty()) pass.refuse_empty();
  filtered.out = pass.counts().filtered_out;
  return filtered;
}

Filtered read_rows(const InputConfig& config) {
  const ScratchFolder folder;
  return read_filtered({folder.write("a.csv", kRows)}, config);
}

}  // namespace

TEST_CASE("without a filter every finite point takes part") {
  const Filtered all = read_rows({});
  CHECK(all.kept == std::vector{0, 1, 2, 3, 4});
  CHECK(all.out.total() == 0);
}

TEST_CASE("bounds keep their faces, and are open in z where they have four numbers") {
  const Filtered flat = read_rows({.bounds = {1, 1, 3, 3}});
  CHECK(flat.kept == std::vector{1, 2, 3});
  CHECK(flat.out.bounds == 2);
  CHECK(read_rows({.bounds = {0, 0, 1.5, 9, 9, 9}}).kept == std::vector{2, 3, 4});
}

TEST_CASE("each row is counted by the first filter that refuses it, in each pass anew") {
  const ScratchFolder folder;
  const Filtered filtered =
      read_filtered({folder.write("a.csv", kRows + "2 1 2 2 2 2\n")},
                    {.bounds = {-1, -1, 3, 3}, .drop_origin = true, .where = "Classification == 2"});
  CHECK(filtered.kept == std::vector{1, 6});
  CHECK(filtered.out.origin == 1);  // row 0
  CHECK(filtered.out.bounds == 1);  // row 4
  CHECK(filtered.out.where == 2);   // rows 2 and 3
}

TEST_CASE("filters that leave no point are an error that names each of them and what there is") {
  const auto error = [](const InputConfig& config) { return error_of([&] { read_rows(config); }); };
  CHECK_THAT(error({.bounds = {10, 10, 11, 11}}),
             Contains("--bounds leaves out 5, the scan lies from 0 0 0 to 4 4 4"));
  CHECK(error({.bounds = {-1, -1, 3, 3}, .drop_origin = true, .where = "Classification == 1"}) ==
        "the filters leave none of the 5 points: --drop-origin leaves out 1; --bounds leaves out 1, the scan "
        "lies from 1 1 1 to 4 4 4; --where leaves out 3");
}

TEST_CASE("withheld points and noise of LAS do not take part, unless they are kept") {
  const ScratchFolder folder;
  const auto las = [&](const std::vector<int>& classes) {
    return folder.write("a.las", las_of_classes(classes));
  };
  constexpr int kWithheld = 128;
  const auto file = las({2, 7, 18, 2 | kWithheld, 7 | kWithheld});
  const Filtered usual = read_filtered({file}, {});
  CHECK(usual.kept == std::vector{0});
  CHECK(usual.out.withheld == 2);
  CHECK(usual.out.noise == 2);
  CHECK(read_filtered({file}, {.keep_withheld = true}).kept == std::vector{0, 3});
  CHECK(read_filtered({file}, {.keep_noise = true}).kept == std::vector{0, 1, 2});
  CHECK(read_filtered({file}, {.keep_noise = true, .where = "Classification == 7"}).kept == std::vector{1});
  const std::vector<ScanInput> posed = {{file, parse_pose("1 2 3 0 0 0 1")}};
  CHECK(read_filtered(posed, {}).out.noise == 2);
  CHECK_THAT(error_of([&] { read_filtered({las({7})}, {}); }),
             Contains("1 are noise, which --keep-noise keeps"));
}

TEST_CASE("filters that leave no point of one file are no error where another file has points") {
  const ScratchFolder folder;
  const auto noise = folder.write("a.las", las_of_classes({7})),
             text = folder.write("b.txt", "x y z\n1 2 3\n");
  CHECK(read_filtered({noise, text}, {}).kept == std::vector{1});
}

TEST_CASE("the classes 7 and 18 of other formats than LAS are labels, which take part") {
  const ScratchFolder folder;
  const auto csv = folder.write("a.csv", "x,y,z,Classification,Withheld\n1,1,1,7,0\n2,2,2,18,0\n3,3,3,7,1\n");
  const auto ply =
      folder.write("a.ply", ascii_ply("1 1 1 7\n2 2 2 18\n", kXyz + "property uchar classification\n"));
  CHECK(read_filtered({csv}, {}).kept == std::vector{0, 1});
  CHECK(read_filtered({ply}, {}).kept == std::vector{0, 1});
}

TEST_CASE("a condition of any attributes says which points take part") {
  const ScratchFolder folder;
  const auto file = folder.write("a.txt", kRows);
  const auto kept = [&](const std::string& where) { return read_filtered({file}, {.where = where}).kept; };
  CHECK(kept("Classification == 2") == std::vector{0, 1});
  CHECK(kept("classification = 6 AND return_number != 1") == std::vector{2});
  CHECK(kept("Classification==6 or NumberOfReturns>=3") == std::vector{2, 3, 4});
  CHECK(kept("not (Classification == 6 || x < 1) && z <= 3.5") == std::vector{1});
  CHECK(kept("x > -1 and !(y > 2)") == std::vector{0, 1, 2});
  CHECK(kept("ReturnNumber == NumberOfReturns") == std::vector{0, 2, 3});
  CHECK(kept("scalar_Return_Number < number_of_returns") == std::vector{1, 4});
  CHECK(read_filtered({file}, {.where = "x > 2"}).out.where == 3);
  check_reasons({{"Colour == 2", "a.txt: no column for 'Colour' of --where; the columns are x, y, z,"},
                 {"x == red", "no column for 'red' of --where"},
                 {"x ~ 2", "--where 'x ~ 2': '~' is no comparison; allowed: comparisons"},
                 {"(x == 2", "a parenthesis is not closed"},
                 {"x == 2 y == 3", "a comparison ends before 'y'"},
                 {"x == 2 and", "a comparison is missing at the end"},
                 {std::string(1000, '('), "nested too deeply"},
                 {"x > 9", "--where leaves out 5"}},
                [&](const std::string& where) { return error_of([&] { kept(where); }); });
}

TEST_CASE("a condition takes the column of its very name, or the only one that is spelled alike") {
  const ScratchFolder folder;
  const auto file = folder.write("a.txt", "x y z Band_1 band1 Band2\n0 0 0 1 2 3\n");
  const auto kept = [&](const std::string& where) { return read_filtered({file}, {.where = where}).kept; };
  for (const char* where : {"band1 == 2", "Band_1 == 1", "band_2 == 3", "\"band 2\" == 3"})
    CHECK(kept(where) == std::vector{0});
  check_reasons({{"BAND1 == 1", "several columns for 'BAND1' of --where: Band_1, band1; allowed"},
                 {"band_9 > 0", "no column for 'band_9'"},
                 {"\"band 2 > 0", "is not closed by a quote"}},
                [&](const std::string& where) { return error_of([&] { kept(where); }); });
}

TEST_CASE("a number of a condition is rounded to the type of its column") {
  const ScratchFolder folder;
  const auto file =
      folder.write("a.ply", ascii_ply("1 1 1 0.1\n2 2 2 0.7\n", kXyz + "property float quality\n"));
  const auto kept = [&](const std::string& where) { return read_filtered({file}, {.where = where}).kept; };
  CHECK(kept("quality <= 0.1") == std::vector{0});
  CHECK(kept("quality >= 0.7") == std::vector{1});
  CHECK(kept("quality > 0.1") == std::vector{1});
}

TEST_CASE("a scan without a point is an error that says why") {
  const ScratchFolder folder;
  const auto error = [&](const std::string& text) {
    return error_of([&] { read_filtered({folder.write("a.csv", text)}, {}); });
  };
  CHECK_THAT(error("x,y,z\n"), Contains("a.csv: no points: a header alone"));
  CHECK_THAT(error("x,y,z\nnan,1,2\ninf,1,2\n"), Contains("a.csv: no points: none of 2 rows has a place"));
}

TEST_CASE("rays without return are at 0 0 0 and at the scanner that a PCD or a PLY names, before a pose") {
  const ScratchFolder folder;
  const auto scan = folder.write("a.pcd", ascii_pcd("0 0 0\n1 2 3\n1 2 4\n10 20 30\n", "1 2 3"));
  CHECK(read_filtered({scan}, {}).kept == std::vector{0, 1, 2, 3});
  CHECK(read_filtered({scan}, {.drop_origin = true}).kept == std::vector{2, 3});
  const Pose pose = parse_pose("0.1 0.2 0.3 0 0 0.6 0.8");
  CHECK(read_filtered({{scan, pose}}, {.drop_origin = true}).kept == std::vector{2, 3});
  const auto ply = folder.write("a.ply", ply_header(kCamera + vertices(3)) + "1 2 3\n0 0 0\n1 2 3\n1 2 4\n");
  CHECK(read_filtered({ply}, {.drop_origin = true}).kept == std::vector{2});
}

}  // namespace lacuna::test
