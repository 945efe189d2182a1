// SPDX-License-Identifier: Apache-2.0
// Points as lines of text: .xyz, .txt, .csv, .pts, .asc.
#pragma once

#include "io/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

bool looks_like_text(const FileStart& start);

// Blanks, commas or semicolons divide the fields: whichever the first row has. Commas within values that
// blanks or semicolons divide are decimal commas. Lines that are blank or begin with # or // are comments. A
// first line that is a bare count says how many rows follow; behind these rows, another count may begin
// another block (.pts). `find_text_columns` says how columns get their names. Every value is kFloat64. Text in
// a column other than x, y and z is NaN, and so is an empty cell. A row with another number of fields is an
// `Error`, but that cells at its end may be missing where commas or semicolons divide them.
std::unique_ptr<ScanReader> open_text(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
