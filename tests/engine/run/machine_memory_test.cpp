// SPDX-License-Identifier: Apache-2.0
#include "engine/run/machine_memory.hpp"

#include "tests/support/test.hpp"

namespace lacuna {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

void write(const ScratchFolder& folder, const std::string& group, const std::string& file,
           const std::string& limit) {
  fs::create_directories(folder / group);
  folder.write(group + "/" + file, limit + "\n");
}

TEST_CASE("a process may have what the tightest of its control groups allows") {
  const ScratchFolder folder;
  const std::string groups = folder.write("groups", "0::/batch/job\n");
  CHECK(group_memory(groups, folder.path()) == kUnlimited);
  write(folder, "batch/job", "memory.max", "max");
  CHECK(group_memory(groups, folder.path()) == kUnlimited);
  write(folder, "batch", "memory.max", "3000000000");
  CHECK(group_memory(groups, folder.path()) == 3'000'000'000);
  write(folder, "batch/job", "memory.max", "2000000000");
  CHECK(group_memory(groups, folder.path()) == 2'000'000'000);
  write(folder, "other", "memory.max", "1");
  CHECK(group_memory(groups, folder.path()) == 2'000'000'000);
}

TEST_CASE("control groups of the first version are by controller, and may name what cannot be seen") {
  const ScratchFolder folder;
  const std::string groups = folder.write("groups", "5:memory:/docker/1234\n4:cpu:/docker/1234\nnonsense\n");
  write(folder, "memory", "memory.limit_in_bytes", "5000000000");
  write(folder, "cpu", "memory.limit_in_bytes", "1");
  CHECK(group_memory(groups, folder.path()) == 5'000'000'000);
  CHECK(group_memory(folder / "none", folder.path()) == kUnlimited);
}

}  // namespace
}  // namespace lacuna
