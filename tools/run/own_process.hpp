// SPDX-License-Identifier: Apache-2.0
// The settings that the program makes in its own process. They keep it to the memory limit, and let it start
// as many threads as are wanted. The library makes no such setting, since it may run in the process of
// another program.
#pragma once

#include "engine/config/config.hpp"

namespace lacuna::tools {

// Sets the allocator up, gives back the memory of the start, and allows more threads than there are cores.
// Call it once.
void prepare_process(const RunConfig& config);

}  // namespace lacuna::tools
