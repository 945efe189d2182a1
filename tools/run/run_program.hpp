// SPDX-License-Identifier: Apache-2.0
// The frame of both programs, `lacuna` and `lacuna-bench`: the process, its errors, its exit codes.
#pragma once

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

}  // namespace lacuna::tools
