// Ctrl-C and kill: the program ends at once, but not before what it keeps on disk meanwhile is gone.
#pragma once

#include <filesystem>
#include <functional>

namespace lacuna {

// From now on SIGINT, SIGTERM and SIGHUP remove what is named below and end the program with exit code
// 128 + signal. Call before any other thread starts: the signals are blocked in all threads and waited for
// in one of its own, where, unlike in a signal handler, removing files is safe. Throws `Error` if that thread
// cannot be started.
void handle_signals();

// A file, or a folder with all it holds; it need not exist.
void remove_on_signal(const std::filesystem::path& path);
// The same of what is made here: a signal finds it named, or not made yet.
std::filesystem::path make_removed_on_signal(const std::function<std::filesystem::path()>& make);
void keep_on_signal(const std::filesystem::path& path);

// Does not return if a signal is ending the program: what fails meanwhile fails because of it.
void wait_if_interrupted();

}  // namespace lacuna
