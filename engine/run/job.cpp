#include "engine/run/job.hpp"

#include "engine/run/machine_memory.hpp"

#include <algorithm>
#include <chrono>

#include <malloc.h>

namespace lacuna {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;

// The program, its libraries, threads' stacks, buffers of readers and writers: measured 28 MiB.
constexpr std::uint64_t kProgram = 36 * kMiB;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Memory Memory::share(std::uint64_t limit) {
  if (limit == 0) limit = machine_memory() / 2;
  const std::uint64_t rest = limit > kProgram + 16 * kMiB ? limit - kProgram : 16 * kMiB;
  // Tiles and the global stage are not at work at the same time. What is left over is for what the
  // allocator cannot give back at once.
  return {.limit = limit,
          .cells = rest / 6,
          .tiles = rest * 2 / 5,
          .spills = rest / 8,
          .global = rest * 3 / 5,
          .reading = rest * 2 / 5};
}

Job::Job(const Config& config, std::filesystem::path workspace, Progress& progress)
    : config(config),
      workspace(std::move(workspace)),
      progress(progress),
      arena(static_cast<std::size_t>(config.run.threads)),
      memory(Memory::share(config.run.memory_limit)) {
  // Large arrays come from the system and go back to it; small ones share few arenas. Without this, what
  // threads free stays with them and the process grows beyond its limit. Where the limit is far, memory is
  // kept and used again: fresh pages have to be cleared by the system.
  ::mallopt(M_MMAP_THRESHOLD, static_cast<int>(std::clamp(memory.limit / 256, kMiB, 32 * kMiB)));
  ::mallopt(M_TRIM_THRESHOLD, static_cast<int>(std::clamp(memory.limit / 32, kMiB, 512 * kMiB)));
  ::mallopt(M_ARENA_MAX, static_cast<int>(std::min<std::size_t>(arena.threads(), 4)));
  release_symbol_tables();
}

std::uint64_t Job::tile_bytes(std::uint64_t points) const {
  const auto k = static_cast<std::uint64_t>(config.neighbourhood.k);
  // Stored point, position, id, row, tree, evaluation, edges; and k neighbours in two lists.
  return points * (420 + 12 * k) + kMiB / 4;
}

std::uint64_t Job::tile_points(std::uint64_t points) const {
  constexpr std::uint64_t kLeast = 256;         // below, a tile is all border
  constexpr std::uint64_t kMost = 256 << 10;    // smaller ones have more border; larger ones gain little
  constexpr std::uint64_t kTilesPerThread = 2;  // so that the last tiles do not leave threads idle
  const std::uint64_t threads = arena.threads();
  const std::uint64_t affordable = std::max(memory.tiles / threads / tile_bytes(1024) * 1024, kLeast);
  if (config.run.tile_points > 0)
    return std::min(static_cast<std::uint64_t>(config.run.tile_points), affordable);
  // Halves are not quite equal: without space for the larger ones some would be halved once more.
  const std::uint64_t share = points * 9 / 8 / (kTilesPerThread * threads);
  return std::min(std::clamp(share, std::uint64_t{4096}, kMost), affordable);
}

std::uint64_t Job::cell_points(std::uint64_t points) const {
  constexpr std::uint64_t kFew = 32;
  constexpr std::uint64_t kBytesPerCell = 128;  // with its share of the tree
  // Cuts leave cells about half full.
  return std::max(kFew, 2 * points * kBytesPerCell / memory.cells);
}

Phase::Phase(Job& job, std::string_view name, std::uint64_t total) : job_(job), start_(now()) {
  job_.phases.push_back({std::string(name), 0});
  job_.progress.begin(name, total);
}

void Job::trim() const {
  if (resident_memory().all > memory.limit / 2) ::malloc_trim(0);
}

Phase::~Phase() {
  job_.trim();
  job_.phases.back().seconds = now() - start_;
  job_.progress.end();
}

}  // namespace lacuna
