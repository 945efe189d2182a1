// What the program does to its own process, so that it keeps to the memory limit. The library does none of it,
// since it may run in the process of another program.
#pragma once

#include <cstdint>

namespace lacuna::tools {

// Sets the allocator up, and gives back what starting took. `limit`: in bytes; 0: half of the machine's.
void prepare_memory(std::uint64_t limit);

}  // namespace lacuna::tools
