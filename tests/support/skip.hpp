// SPDX-License-Identifier: Apache-2.0
// Skipped tests. Catch2 v2 knows only passed and failed ones, so a skipped test has an exit code of its own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace lacuna::test {

inline constexpr int kSkippedExitCode = 77;  // SKIP_RETURN_CODE in tests/CMakeLists.txt

// Marks the running test case as skipped and prints why. The caller returns from the test.
void skip(const std::string& reason);

// $LACUNA_SHARED, else `shared` next to the source folder, which has scans and their golden results. Where
// that is no folder: none, and the running test case is skipped.
std::optional<std::filesystem::path> shared_folder();

// Whether every test case that ran was skipped.
bool all_were_skipped();

}  // namespace lacuna::test
