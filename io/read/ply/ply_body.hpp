// SPDX-License-Identifier: Apache-2.0
// The data behind the header of a PLY file, in either encoding.
#pragma once

#include "io/read/ply/ply_header.hpp"

namespace lacuna::io {

// Whether the file can hold the rows that the header declares; throws `Error` if not. Afterwards their number
// is safe to count to.
void require_size(const InputFile& in, const PlyHeader& header);

// Whether values have the other byte order than this machine's.
bool is_swapped(PlyFormat format);

// Reads `count` rows of an element: their scalars packed in `rows` (io/read/ply/ply_rows.hpp).
void read_rows(InputFile& in, PlyFormat format, const PlyElement& element, std::uint64_t count,
               std::byte* rows);

// Passes over all rows of one element.
void skip_rows(InputFile& in, PlyFormat format, const PlyElement& element);

}  // namespace lacuna::io
