// SPDX-License-Identifier: Apache-2.0
// Which files a scan has: whether another run has the same, and whether two of them are one.
#pragma once

#include "io/read/files/result_folder.hpp"
#include "io/read/scan/scan_files.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace lacuna::io {

// Returns name, size, time and a sample of each file, its pose, and the parameters of input, a line each.
// Returns nothing if there are arrays. Throws `Error`.
std::vector<std::string> identity_of(const ScanFiles& scan);

// Returns three texts for each file: its name as given, the absolute one, and its pose or nothing.
std::vector<std::string> kept_names(const ScanFiles& scan);
// Returns the inputs that have these names. A name is as it was given, if it names the same file from here.
LACUNA_API std::vector<ScanInput> inputs_of(std::span<const std::string> kept_names);

// Returns the inputs that are the same file as one before them, ascending.
std::vector<std::size_t> repeated_files(const ScanFiles& scan);

// Throws `Error` if an earlier result that the folder replaces is an input of the scan.
void check_not_input(const ResultFolder& folder, const ScanFiles& scan);

}  // namespace lacuna::io
