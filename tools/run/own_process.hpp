// SPDX-License-Identifier: Apache-2.0
// What the program does to its own process, so that it keeps to the memory limit and starts as many threads
// as are wanted. The library does none of it, since it may run in the process of another program.
#pragma once

#include "engine/config/config.hpp"

namespace lacuna::tools {

// Sets the allocator up, gives back what starting took, and allows more threads than there are cores. To be
// called once.
void prepare_process(const RunConfig& config);

}  // namespace lacuna::tools
