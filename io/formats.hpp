// SPDX-License-Identifier: Apache-2.0
// The formats that are read.
#pragma once

#include "engine/export.hpp"
#include "io/rows/scan_reader.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>

namespace lacuna::io {

// How sure the program is of the format of a file, by its first bytes. `recognise` throws `Error` if the file
// cannot be opened.
enum class Recognised : std::uint8_t {
  kNo,      // no format that is read
  kAsText,  // text, of rows of numbers or of anything else
  kYes,
};
LACUNA_API Recognised recognise(const std::filesystem::path& file);

// Opens a file by its content, not by its name. Throws `Error`.
LACUNA_API std::unique_ptr<ScanReader> open_scan(const std::filesystem::path& file,
                                                 const ReadOptions& options);

}  // namespace lacuna::io
