// SPDX-License-Identifier: Apache-2.0
// Whether a scan has a roof, such as a ceiling, that hides all else from above. Pages and pictures begin
// below it.
#pragma once

#include "io/write/report/scene.hpp"

#include <optional>

namespace lacuna::io {

// Returns the height below which a view sees into the scan, in coordinates of the scan; none without a roof.
// A roof covers at least 0.6 of the plan, with points at least 0.4 of all heights below it. Cost: linear.
std::optional<double> roof_height(const Scene& scene);

}  // namespace lacuna::io
