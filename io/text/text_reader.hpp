// SPDX-License-Identifier: Apache-2.0
// Points as lines of text: .xyz, .txt, .csv, .pts, .asc.
#pragma once

#include "io/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

bool looks_like_text(const FileStart& start);

// Blanks, commas or semicolons divide the fields: whichever the first line has. If that line is a header and
// the first row does not fit it, the first row decides. Commas within values that blanks or semicolons divide
// are decimal commas. Lines that are blank or begin with # or // are comments. A first line that is a bare
// count says how many rows follow; behind these rows, another count may begin another block (.pts). The
// options name columns, else a header line does. The header may be a comment just before the first line of
// values. It must name as many columns as that line has, x, y and z among them. Else columns are x y z
// column_4 ... The option "x=Easting" names a column of the header anew. Without names, a first column that
// counts the rows, before at least three others, is an `Error`, because it would be read as x. Names x y z nx
// ny nz count in upper case, too. Every value is kFloat64. A row with another number of fields, or with one
// that is not a number, is an `Error`.
std::unique_ptr<ScanReader> open_text(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
