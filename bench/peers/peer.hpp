// SPDX-License-Identifier: Apache-2.0
// Code that the peers share: their scan, their command line, and the report of their times.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <thread>
#include <vector>

namespace lacuna::peers {

// Returns x y z of every point with finite coordinates, one after the other, by Lacuna's own readers. So the
// time of the peers' readers does not count. Throws `lacuna::Error`.
std::vector<float> read_scan(const char* file);

// Calls `run` with what main() got, if that has so many words; else prints the usage. Returns the exit code.
template <class Run>
int run_main(int argc, char** argv, int fewest, int most, const char* usage, const Run& run) {
  if (argc <= fewest || argc > most + 1) {
    std::fprintf(stderr, "usage: %s %s\n", argv[0], usage);
    return 2;
  }
  try {
    run();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}

struct Arguments {
  const char* scan;
  int threads = static_cast<int>(std::thread::hardware_concurrency());
  int neighbours = 15;
  double degrees = 90;        // of PCL alone, whose own default it is
  const char* out = nullptr;  // folder for a result, of PCL alone
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

// The command line is PROGRAM SCAN.ply [THREADS [NEIGHBOURS [DEGREES [OUT_FOLDER]]]].
template <class Run>
int run_peer(int argc, char** argv, const Run& run) {
  return run_main(argc, argv, 1, 5, "SCAN.ply [THREADS [NEIGHBOURS [DEGREES [OUT_FOLDER]]]]", [&] {
    Arguments arguments{.scan = argv[1]};
    if (argc > 2) arguments.threads = std::atoi(argv[2]);
    if (argc > 3) arguments.neighbours = std::atoi(argv[3]);
    if (argc > 4) arguments.degrees = std::atof(argv[4]);
    if (argc > 5) arguments.out = argv[5];
    if (arguments.neighbours < 3 || !(arguments.degrees > 0 && arguments.degrees <= 360))
      throw std::runtime_error("NEIGHBOURS must be 3 or more, DEGREES above 0 and at most 360");
    const Result result = run(arguments);
    std::printf("points %zu\nboundary_points %zu\nload %.6f\nnormals %.6f\nboundary %.6f\nuntimed %.6f\n",
                result.points, result.boundary_points, result.load, result.normals, result.boundary,
                result.untimed);
  });
}

}  // namespace lacuna::peers
