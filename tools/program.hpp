// SPDX-License-Identifier: Apache-2.0
// The program `lacuna`: its commands.
#pragma once

namespace lacuna::tools {

// Returns the exit code, as tools/run/run_program.hpp says.
int run(int argc, char** argv);

}  // namespace lacuna::tools
