// SPDX-License-Identifier: Apache-2.0
// What every test has: Catch2, Eigen, the standard library, and a few short names. Most headers of tests/
// include it; a test includes one of them, or this one.
#pragma once

#include "engine/run/error.hpp"
#include "tests/support/scratch_folder.hpp"

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
using test::ScratchFolder;

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

}  // namespace test

}  // namespace lacuna
