// SPDX-License-Identifier: Apache-2.0
// Files that a process has open, with or without a name: what happens to a run when one of them changes.
#pragma once

#include <string>

#include <sys/types.h>

namespace lacuna::test {

// Whether `process` has a file open that was created as `name`, in whatever folder, and that is not empty.
bool has_open(pid_t process, const std::string& name);

// Cuts it to half of its length. False if there is none.
bool cut_open_file(pid_t process, const std::string& name);

}  // namespace lacuna::test
