// SPDX-License-Identifier: Apache-2.0
// The program `lacuna`: its subcommands and what its exit codes mean.
#pragma once

namespace lacuna::tools {

// 0: done; 1: failed, one line on stderr; 2: wrong usage, one line on stderr; 128 + n: ended by signal n.
int run(int argc, char** argv);

}  // namespace lacuna::tools
