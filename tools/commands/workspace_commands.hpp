// SPDX-License-Identifier: Apache-2.0
// lacuna status and lacuna clean: the content of a workspace, and its removal.
#pragma once

#include "engine/kept_state.hpp"

#include <string>

namespace lacuna::tools {

// Returns "level 0: 12 of 20 tiles evaluated; level 1: ...".
std::string print_state(const KeptState& state);

}  // namespace lacuna::tools
