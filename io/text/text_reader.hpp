// Points as lines of text: .xyz, .txt, .csv, .pts, .asc.
#pragma once

#include "io/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

bool looks_like_text(const FileStart& start);

// Fields divided by blanks, commas or semicolons: whichever the first line has. Where that is a header and
// the first row does not fit it, whichever this row has. Commas within values that blanks or semicolons
// divide are decimal commas. Lines that are blank or begin with # or // are comments. A first line that is a
// bare count says how many rows follow; behind these, another count may begin another block (.pts). Columns
// are named by the options, else by a header line (or a comment just before the first row that names as many
// columns as it has, x, y and z among them), else x y z column_4 ... The option "x=Easting" names a column of
// the header anew. Names x y z nx ny nz count in upper case too. Every value is kFloat64; a row with another
// number of fields, or one that is not a number, is an `Error`.
std::unique_ptr<ScanReader> open_text(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
