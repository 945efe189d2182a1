// SPDX-License-Identifier: Apache-2.0
// Measures how fast each format is read from the page cache, as the engine reads it: positions, in batches.
// Counters are points and bytes of the file per second. `lacuna_formats write FOLDER POINTS` writes one file
// in each format instead, for whole runs.
#include "bench/sample.hpp"
#include "bench/scan_files.hpp"
#include "engine/store/temporary_folder.hpp"
#include "io/scan/file_scan.hpp"

#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

namespace lacuna {
using namespace io;

namespace {

constexpr std::uint32_t kPoints = 2'000'000;

const std::filesystem::path& folder() {
  static const TemporaryFolder made(std::filesystem::temp_directory_path(), "lacuna-formats-");
  return made.path();
}

const PointBatch& sample() {
  static const PointBatch batch = sample_surface(kPoints, SampleOrder::kScanline);
  return batch;
}

std::uint64_t read_positions(FileScan& scan) {
  std::uint64_t points = 0;
  scan.rewind();
  for (PointBatch batch; scan.next(batch);) {
    points += batch.size();
    benchmark::DoNotOptimize(batch.positions.data());
  }
  return points;
}

void read_format(benchmark::State& state, const SampleFormat& format) {
  const auto file = folder() / ("sample." + std::string(format.ending));
  format.write(sample(), file);
  FileScan scan({file}, {});
  const auto threads = static_cast<int>(state.range(0));
  tbb::task_arena arena(threads);
  std::uint64_t points = 0;
  arena.execute([&] {
    for (auto _ : state) points = read_positions(scan);
  });
  state.SetItemsProcessed(static_cast<std::int64_t>(points) * state.iterations());
  state.SetBytesProcessed(static_cast<std::int64_t>(std::filesystem::file_size(file)) * state.iterations());
  std::filesystem::remove(file);
}

void register_formats() {
  for (const SampleFormat& format : sample_formats()) {
    benchmark::RegisterBenchmark(format.name,
                                 [&format](benchmark::State& state) { read_format(state, format); })
        ->ArgName("threads")
        ->Arg(1)
        ->Arg(2)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
}

// Returns a format's name as part of a file name: "LAZ 1.4, format 7" becomes laz-1.4-format-7.
std::string file_name(const SampleFormat& format) {
  std::string name;
  for (const char c : std::string_view(format.name)) {
    if (c == ' ') name += '-';
    if (c != ' ' && c != ',') name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return name + "." + format.ending;
}

void write_samples(const std::filesystem::path& folder, std::uint32_t points) {
  const PointBatch sample = sample_surface(points, SampleOrder::kScanline);
  for (const SampleFormat& format : sample_formats()) format.write(sample, folder / file_name(format));
}

}  // namespace
}  // namespace lacuna

int main(int argc, char** argv) {
  if (argc == 4 && argv[1] == std::string_view("write")) {
    lacuna::write_samples(argv[2], static_cast<std::uint32_t>(std::stoul(argv[3])));
    return 0;
  }
  lacuna::register_formats();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
