// SPDX-License-Identifier: Apache-2.0
// Formats that are recognised but not read.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lacuna::io {

// What the file is, and how it becomes one that is read: for the end of an error message. None where the
// first bytes are of no known format.
std::optional<std::string> describe_other_format(std::string_view first_bytes);

}  // namespace lacuna::io
