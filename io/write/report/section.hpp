// SPDX-License-Identifier: Apache-2.0
// Cuts a scene at a height: the points above would hide the rest, as a ceiling does.
#pragma once

#include "io/write/report/scene.hpp"

namespace lacuna::io {

// Leaves out the points above `height`, in coordinates of the scan. Loops that lie above it with all of their
// vertices have none afterwards, as loops through strays. Cost: linear.
void hide_above(Scene& scene, double height);

}  // namespace lacuna::io
