// SPDX-License-Identifier: Apache-2.0
// The rows of one element of a PLY file, in both encodings.
#pragma once

#include "io/read/ply/ply_header.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace lacuna::io {

// Reads `count` rows: their scalars packed in `rows` as in PlyElement::layout, lists passed over. Memory
// does not grow with the rows or the lists (ASCII: a line is at most as long as InputFile's buffer). Throws
// `Error` where the file ends or does not hold what the header says.
void read_ascii_rows(InputFile& in, const PlyElement& element, std::uint64_t count, std::byte* rows);
void read_binary_rows(InputFile& in, const PlyElement& element, bool swapped, std::uint64_t count,
                      std::byte* rows);

// Passes over `count` rows.
void skip_ascii_rows(InputFile& in, const PlyElement& element, std::uint64_t count);
void skip_binary_rows(InputFile& in, const PlyElement& element, bool swapped, std::uint64_t count);

// Passes over all rows of an element without lists, by lines, without counting values.
void skip_ascii_lines(InputFile& in, const PlyElement& element);

using ListVisitor = std::function<void(std::span<const std::int64_t> values)>;

// Hands on the values of one list of each row. `list` is an index into the element's properties; the list
// holds integers. Memory grows with the longest list.
void visit_ascii_lists(InputFile& in, const PlyElement& element, std::size_t list, const ListVisitor& visit);
void visit_binary_lists(InputFile& in, const PlyElement& element, bool swapped, std::size_t list,
                        const ListVisitor& visit);

}  // namespace lacuna::io
