// SPDX-License-Identifier: Apache-2.0
// The formats that are read.
#pragma once

#include "engine/export.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

namespace lacuna::io {

// `kText` is text of rows of numbers, or of anything else.
enum class Format : std::uint8_t { kPly, kLas, kPcd, kE57, kObj, kPtx, kText };

// Returns the format that the first bytes of a file show; nothing if none is read. Throws `Error` if the file
// cannot be opened.
LACUNA_API std::optional<Format> find_format(const std::filesystem::path& file);
// Returns the format likewise. Throws `Error` that says what the file is instead, and a way out.
Format format_of(const std::filesystem::path& file);

// Opens a file of this format. Throws `Error`.
std::unique_ptr<ScanReader> open_scan(Format format, const std::filesystem::path& file,
                                      const ReadOptions& options);
// Opens a file by its content, not by its name. Throws `Error`.
LACUNA_API std::unique_ptr<ScanReader> open_scan(const std::filesystem::path& file,
                                                 const ReadOptions& options);

}  // namespace lacuna::io
