// SPDX-License-Identifier: Apache-2.0
// The frame of both programs, `lacuna` and `lacuna-bench`: the process, its errors, its exit codes, and its
// signals.
#pragma once

#include <filesystem>
#include <string>

namespace lacuna::tools {

class CommandLine;

// Ends a command whose answer is no, such as that an area has voids. It is no error: all was done.
struct AnswerIsNo {
  std::string answer;
  bool is_decided = true;  // false: neither yes nor no
};

// Ends the process with one line if the system allows it too little. Libraries start threads before `main`.
// So a program names this function in its section .preinit_array, which comes before them.
void check_limits(int count, char** words, char** environment);

// Runs the command that the arguments name. `name` is the program's, before each line on stderr. Returns the
// exit code. 0: done; 1: failed, or the answer is no; 2: wrong usage; 3: the answer is not decided. But for 0
// there is one line on stderr. A signal n ends the process with the exit code 128 + n.
int run_program(const std::string& name, CommandLine& line, int argc, char** argv);

// Ctrl-C and kill: the program ends at once, after it has removed its temporary files from the disk.

// From now on SIGINT, SIGTERM and SIGHUP remove the temporary folders (engine/store/temporary_folder.hpp) and
// empty folders that were made for the run (tools/run/folders.hpp). They print one line, if stderr takes it
// at once, and end the program with exit code 128 + signal. Call before any other thread starts. The signals
// are blocked in all threads and awaited in one of its own, where, unlike in a signal handler, removing files
// is safe. Throws `Error` if that thread cannot be started.
void handle_signals();

// The run replaces results in `folder`, all or none; `report` is one of them, and shows by its identity
// whether that has happened. From now on the line about a signal says so: "lacuna: interrupted; DIR is as it
// was".
void watch_results(const std::filesystem::path& folder, const std::filesystem::path& report);

// This folder keeps finished work, and the line about a signal says so.
void watch_workspace(const std::filesystem::path& folder);

// The results have replaced the files in the folder of watch_results.
void note_complete_results();
// Returns a text for the line of a later error: "; the results in DIR are complete"; empty before.
std::string complete_results();

// Does not return if a signal is ending the program: what fails meanwhile fails because of it.
void wait_if_interrupted();

}  // namespace lacuna::tools
