// lacuna compare: the holes of two results, by place.
#pragma once

#include <CLI/CLI.hpp>

namespace lacuna::tools {

void add_compare_command(CLI::App& app);

}  // namespace lacuna::tools
