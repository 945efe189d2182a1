// SPDX-License-Identifier: Apache-2.0
// What every test has: Catch2, Eigen, the standard library, a folder of its own, and a few short names. Most
// headers of tests/ include it; a test includes one of them, or this one.
#pragma once

#include "engine/run/error.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>
#include <queue>
#include <random>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <Eigen/Geometry>

namespace lacuna::io {}

namespace lacuna {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace test {

using namespace io;
using Names = std::vector<std::string>;
using Rows = std::vector<std::vector<double>>;

// What the job ends with; empty: it does not.
template <class Expected = Error, class Job>
std::string error_of(Job&& job) {
  try {
    job();
  } catch (const Expected& error) {
    return error.what();
  }
  return {};
}

// Marks the running test case as skipped and prints why. The caller returns from the test.
void skip(const std::string& reason);

// $LACUNA_SHARED, else `shared` next to the source folder, which has scans and their golden results. Where
// that is no folder: none, and the running test case is skipped.
std::optional<fs::path> shared_folder();

// Gone at the end, with all that is in it. Its name has spaces.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const fs::path& path() const { return path_; }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  std::string write(const std::string& name, std::string_view content) const;  // the file's path
  std::vector<std::string> names() const;                                      // of what is in it, sorted

 private:
  fs::path path_;
};

std::vector<std::string> names_of(const fs::path& folder);  // of what is in it, sorted

// Without hidden ones, which begin with a dot.
std::size_t count_entries(const fs::path& folder);

// Returns the temporary folder of the run that makes these results. It is empty where there is none.
fs::path temporary_of(const fs::path& results);

std::string read_file(const fs::path& file);

}  // namespace test

using test::ScratchFolder;

// Returns how many of `cases` to draw, at least one: the share LACUNA_DRAWN_SHARE, which `tools/check.sh` sets for
// slow tests; all where it is not set.
inline std::uint64_t draws(std::uint64_t cases) {
  const char* share = std::getenv("LACUNA_DRAWN_SHARE");
  const double some = share ? std::strtod(share, nullptr) * double(cases) : double(cases);
  return std::clamp<std::uint64_t>(some > 0 ? std::uint64_t(some) : 0, 1, cases);
}

}  // namespace lacuna
