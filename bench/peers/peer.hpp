// SPDX-License-Identifier: Apache-2.0
// Code that both peers share: their command line, and the report of their times.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>

namespace lacuna::peers {

struct Arguments {
  const char* scan;
  int threads = static_cast<int>(std::thread::hardware_concurrency());
  int neighbours = 15;
};

// Measures the seconds since the last call, or since the object was made.
class Clock {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

struct Result {
  std::size_t points = 0;
  std::size_t boundary_points = 0;
  double load = 0, normals = 0, boundary = 0;  // seconds
  double untimed = 0;                          // seconds, not to be counted
};

// The command line is PROGRAM SCAN.ply [THREADS [NEIGHBOURS]].
template <class Run>
int run_peer(int argc, char** argv, Run&& run) {
  if (argc < 2 || argc > 4) {
    std::fprintf(stderr, "usage: %s SCAN.ply [THREADS [NEIGHBOURS]]\n", argv[0]);
    return 2;
  }
  Arguments arguments{.scan = argv[1]};
  if (argc > 2) arguments.threads = std::atoi(argv[2]);
  if (argc > 3) arguments.neighbours = std::atoi(argv[3]);
  try {
    const Result result = run(arguments);
    std::printf("points %zu\nboundary_points %zu\nload %.6f\nnormals %.6f\nboundary %.6f\nuntimed %.6f\n",
                result.points, result.boundary_points, result.load, result.normals, result.boundary,
                result.untimed);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}

}  // namespace lacuna::peers
