// SPDX-License-Identifier: Apache-2.0
// Extra bytes: values of points that are no fields of the point format (LAS 1.4 R15, table 24).
#pragma once

#include "io/read/las/las_header.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace lacuna::io {

// For types 1 to 10: the bytes of a value, and the scalar type that keeps it.
struct LasExtraType {
  std::size_t bytes;
  Scalar kept;
};
const LasExtraType& las_extra_type(std::uint8_t type);

// Returns a stored value of type 1 to 10, without scale and offset.
double load_las_value(std::uint8_t type, const std::byte* from);

// Returns the stored value that means no data, of value `i` of a type of several; empty without one.
std::optional<double> las_no_data(const LasExtraBytes& extra, std::size_t i);

// Returns the bytes in a point: of one, two or three values, or without a type; 0 if the type is not known.
std::size_t las_extra_size(const LasExtraBytes& extra);

// Describes one value for each point. Names and descriptions are cut to 32 bytes.
LasExtraBytes las_extra_of(std::string_view name, Scalar type, std::string_view description);
// Describes 1 to 255 bytes that have no type.
LasExtraBytes las_extra_without_type(std::size_t bytes);

// The descriptions of a run's results begin with this text, so that the next run replaces them.
inline constexpr std::string_view kLacunaDescription = "Lacuna: ";
bool is_lacuna_extra(const LasExtraBytes& extra);

// Returns the extra bytes of each point of a file, in order, with the bytes that its header does not
// describe.
std::vector<LasExtraBytes> las_extra_of_points(const LasHeader& header);

}  // namespace lacuna::io
