// SPDX-License-Identifier: Apache-2.0
// The name and the form of voids.json, which docs/area.md describes.
#pragma once

#include <string_view>

namespace lacuna::io {

inline constexpr const char* kVoidsFile = "voids.json";
inline constexpr std::string_view kVoidsSchema = "voids 2";

inline constexpr std::string_view kShareColumn = "in_";  // before the name of a class

}  // namespace lacuna::io
