// SPDX-License-Identifier: Apache-2.0
// Encodes items of version 1, which LASzip wrote before 2011: POINT10, GPSTIME11, RGB12 and BYTE. For tests
// of the decoder; written after the specification that io/laz/laz.hpp cites, simple and slow.
#pragma once

#include "io/laz/laz.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace lacuna::test {

// One chunk, of at least one record.
std::vector<std::byte> laz_chunk_of_version1(const io::laz::Layout& layout,
                                             std::span<const std::byte> records);

}  // namespace lacuna::test
