// SPDX-License-Identifier: Apache-2.0
// The readers of formats, among which formats.cpp chooses. `looks_like_x` sees the first bytes of a file and
// its size, and never its name.
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

// LAS 1.0 to 1.5, point formats 0 to 10 (ASPRS LAS specification 1.4 R15).

bool looks_like_las(const FileStart& start);

// Coordinates are stored * scale + offset, in double precision. Every field of the point format and the extra
// bytes are columns. Extended records behind the points are passed over. A file that is too short for the
// points that its header declares is an `Error` at once.
std::unique_ptr<ScanReader> open_las(const std::filesystem::path& file, const ReadOptions& options);

// PLY, ASCII and binary: the points are the rows of element "vertex".

bool looks_like_ply(const FileStart& start);

// An offset in the header is added to the coordinates, which are then coordinates of the scan. Scalars may
// have any type. Lists and other elements are passed over, but must be complete, and nothing may follow the
// last one. A file too short for its header is an `Error` at once. Its camera is a scanner,
// and a place of rays without return.
std::unique_ptr<ScanReader> open_ply(const std::filesystem::path& file, const ReadOptions& options);

// PCD, the point clouds of PCL: ASCII, binary and compressed, versions .5 to .7.

bool looks_like_pcd(const FileStart& start);

// Every field becomes properties: `a` of COUNT 3 becomes a_0 a_1 a_2. Integers of 8 bytes become doubles, so
// that values above 2^53 are rounded. normal_x normal_y normal_z become nx ny nz. The packed colours `rgb`
// and `rgba` become the bytes red green blue and alpha. Fields named `_` are padding and left out. VIEWPOINT
// is a place of rays without return; coordinates stay as they are. Points that are NaN are rows like any
// others. A file too short for its header is an `Error`. So is a file with more data behind its rows, apart
// from zeros in a binary file. A compressed file stores each field for all points, one field after the other.
// It is unpacked twice, by one stream for each field, at most 256 of them. Memory besides the batch: 70 KiB a
// field, whatever the number of points.
std::unique_ptr<ScanReader> open_pcd(const std::filesystem::path& file, const ReadOptions& options);

// OBJ, the text format of Wavefront: the vertices of a mesh.

bool looks_like_obj(const FileStart& start);

// Rows are vertices "v x y z", in file order, with x y z as doubles. The first vertex decides the values that
// every other has, too. A fourth value is a weight and left out; three more are red green blue, floats as
// they are in the file. Normals "vn" become nx ny nz if there are as many as vertices. Every face that names
// normals must also give each vertex the normal of the vertex's own number. Else the normals belong to faces
// or corners, and are left out. Lines of other kinds are skipped. A line that ends with a backslash goes on
// in the next one. Opening reads the whole file once, to count.
std::unique_ptr<ScanReader> open_obj(const std::filesystem::path& file, const ReadOptions& options);

// Points as lines of text: .xyz, .txt, .csv, .pts, .asc.

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
