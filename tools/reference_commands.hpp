// SPDX-License-Identifier: Apache-2.0
// The subcommands `lacuna manual`, `lacuna completion` and `lacuna help`.
#pragma once

namespace CLI {
class App;
}

namespace lacuna::tools {

// The words behind it are commands, too.
inline constexpr const char* kHelpCommand = "help";

// They describe all commands of `app`, those that are added later too.
void add_reference_commands(CLI::App& app);

}  // namespace lacuna::tools
