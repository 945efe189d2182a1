// SPDX-License-Identifier: Apache-2.0
// Points as lines of text: .xyz, .txt, .csv, .pts, .asc.
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

bool looks_like_text(const FileStart& start);

// Blanks, commas, semicolons or tabs divide the fields: whichever the first row has. If it does not fit the
// header, the header decides. Commas within values that blanks or semicolons divide are decimal commas.
// Quotes around values are no part of them. Lines that are blank or begin with # or // are comments. A first
// line that is a bare count says how many rows follow; behind these rows, another count may begin another
// block (.pts). The options name columns, else a header line or a comment before the rows does. Lines of text
// may come before a header that names a position (name_position in io/read/rows/column_rules.hpp). Else
// columns are x y z column_4 ... The option "x=Easting" names a column of the header anew. A column named
// "_", or with words in the first rows, is not read; a last name "..." allows more values. Columns without
// names are an `Error` where `doubt_of_first_columns` doubts them. Every value is kFloat64; an empty cell is
// NaN. A row with another number of fields, or with one that is not a number, is an `Error`.
std::unique_ptr<ScanReader> open_text(const std::filesystem::path& file, const ReadOptions& options);

// PTX: scans of Leica and others as text, each with its grid of rays and its pose.

// Whether the file begins with two bare counts, then three numbers.
bool looks_like_ptx(const FileStart& start);

// Blocks come one after the other. A block has the columns and rows of the grid, the place and axes of the
// scanner, and a 4 x 4 matrix. Then it has one line for each ray. A line is x y z intensity, or x y z
// intensity red green blue. The matrix is applied, so all blocks are in the same coordinates. It must be a
// pose (io/read/rows/pose.hpp). Rays without a return, 0 0 0, have coordinates that are not numbers: they
// stay rows, and the engine drops and counts them. Columns: x y z intensity (red green blue) scan, the number
// of the block.
std::unique_ptr<ScanReader> open_ptx(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
