// SPDX-License-Identifier: Apache-2.0
// Every reader on broken files: cut at every length, and changed at random.
//
// A broken file gives one clear `Error`, or a right answer. A reader of any format is covered by one list of
// small files, which conformance_test.cpp hands to the functions below.
#pragma once

#include "tests/io/io_support.hpp"

namespace lacuna::test {

using Point = std::array<double, 3>;
using PointVisitor = std::function<void(const Point&)>;

// Reads a file and hands on its points, in batches of at most `max_rows`. Throws `Error`, or std::logic_error
// where the reader contradicts itself.
using Reading = std::function<void(const fs::path& file, std::size_t max_rows, std::uint64_t most_points,
                                   const PointVisitor& visit)>;

// By `open_scan`. The rows are packed and have x, y and z, properties differ in name, and batches have the
// bytes of their rows. The number of rows is the expected one, never more than `most_points`.
void read_scan(const fs::path& file, std::size_t max_rows, std::uint64_t most_points,
               const PointVisitor& visit);

// A file that can be read, with as much in it as its format has.
struct WholeFile {
  std::string name;
  std::string bytes;
  // From this length on a beginning of it is complete, and has all points. 0: the format has no count, so
  // that any beginning may be complete; it has the first points of the whole.
  std::size_t complete_from = static_cast<std::size_t>(-1);
  // No file of the format may give more. Only compressed or packed bits take less than a byte for a point.
  std::uint64_t points_in_a_byte = 1;
  std::uint64_t megabytes = 64;  // of memory for reading it, however broken it is
  Reading read = read_scan;
};

// Small files of each format: in its own test. `some_las_files` are a few of `all_las_files`, LAZ among them.
std::vector<WholeFile> ply_files();
std::vector<WholeFile> pcd_files();
std::vector<WholeFile> obj_files();
std::vector<WholeFile> ptx_files();
std::vector<WholeFile> text_files();
std::vector<WholeFile> some_las_files();
std::vector<WholeFile> all_las_files();
std::vector<WholeFile> e57_files();

// Every length of each file, and 300 changed files in all. A failure names the seed and the number of the
// change, and mutated() gives that file again. After a crash it is left in the folder for temporary files.
void check_broken_files(const std::vector<WholeFile>& files, std::uint32_t seed);

// Every length of each file, and 10,000 changed ones of each. For slow tests.
void check_many_broken_files(const std::vector<WholeFile>& files, std::uint32_t seed);

// Files changed at random, the same for the same seed.

// Returns `whole` with one to four random changes. Bytes are set, spans removed, repeated or inserted,
// integers and numbers of text become extreme values, or the end is cut off. Each `number` gives a file of
// its own, on every machine the same.
std::string mutated(const std::string& whole, std::uint32_t seed, std::uint32_t number);

}  // namespace lacuna::test
