// `lacuna detect`: from scan files to their holes on disk.
#pragma once

namespace CLI {
class App;
}

namespace lacuna::tools {

// It runs when parsed. Throws `Error` when the job fails, `CLI::Error` for wrong usage.
void add_detect_command(CLI::App& app);

}  // namespace lacuna::tools
