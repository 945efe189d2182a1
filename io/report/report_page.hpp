// SPDX-License-Identifier: Apache-2.0
// The page of a report, with a scene as its data.
#pragma once

#include "io/files/output_file.hpp"
#include "io/report/scene.hpp"

namespace lacuna::io {

// Writes the page of io/report/page with the scene as data. Positions are 21 bits along each axis, of the
// cube of the scene. A point takes about 15 bytes, a vertex of a loop 11.
void write_report(const Scene& scene, OutputFile& out);

}  // namespace lacuna::io
