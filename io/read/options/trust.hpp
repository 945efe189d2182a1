// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lacuna::io {

// Which number of points holds where a file's header counts others than the file has.
enum class Trust : std::uint8_t { kNeither, kHeader, kFile };

}  // namespace lacuna::io
