// SPDX-License-Identifier: Apache-2.0
#include "io/files/number.hpp"
#include "io/loops/lids_reader.hpp"
#include "io/results/lids.hpp"

#include <string>

namespace lacuna::io {

void write_lids_table(const std::filesystem::path& lids_obj, OutputFile& out) {
  out.write("loop,triangles,lid_area,reason\n");
  read_lids(lids_obj, {.hole = [&](const LidRecord& hole) {
              std::string line = std::to_string(hole.loop) + "," + std::to_string(hole.triangles) + ",";
              if (hole.left_out.empty()) append_shortest(line, hole.area);
              out.write(line + "," + hole.left_out + "\n");
            }});
}

}  // namespace lacuna::io
