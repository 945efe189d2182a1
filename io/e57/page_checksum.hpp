// SPDX-License-Identifier: Apache-2.0
// The checksum of a page of an E57 file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lacuna::io {

// CRC-32C (polynomial 0x1EDC6F41, reflected, all bits inverted before and after): ASTM E2807-11; RFC 3720,
// 12.1. The result is the same on every machine. Cost: linear.
std::uint32_t page_checksum(std::span<const std::byte> data);

}  // namespace lacuna::io
