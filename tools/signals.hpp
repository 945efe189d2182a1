// Ctrl-C and kill: the program ends at once, but not before what it keeps on disk meanwhile is gone.
#pragma once

#include <filesystem>

namespace lacuna::tools {

// From now on SIGINT, SIGTERM and SIGHUP remove the temporary folders (engine/store/temporary_folder.hpp) and
// empty folders that were made for the run (tools/workspace.hpp). They print one line, if stderr takes it at
// once, and end the program with exit code 128 + signal. Call before any other thread starts: the signals are
// blocked in all threads and waited for in one of its own, where, unlike in a signal handler, removing files
// is safe. Throws `Error` if that thread cannot be started.
void handle_signals();

// The run replaces results in `folder`, all or none; `report` is one of them, and shows by its identity
// whether that has happened. From now on the line about a signal says so: "lacuna: interrupted; DIR is as it
// was".
void watch_results(const std::filesystem::path& folder, const std::filesystem::path& report);

// Does not return if a signal is ending the program: what fails meanwhile fails because of it.
void wait_if_interrupted();

}  // namespace lacuna::tools
