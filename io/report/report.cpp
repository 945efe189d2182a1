// SPDX-License-Identifier: Apache-2.0
#include "io/report/report.hpp"

#include "io/report/report_page.hpp"
#include "io/report/scene.hpp"

namespace lacuna::io {

namespace fs = std::filesystem;

fs::path write_report(const fs::path& folder, Overwrite overwrite) {
  const fs::path file = folder / "report.html";
  check_output(file, kReportMark, overwrite);
  Scene scene = read_scene(folder);
  scene.next_stations = read_next_stations(folder);
  OutputSet set(overwrite);
  write_report(scene, set.add(file, kReportMark));
  set.commit();
  return file;
}

}  // namespace lacuna::io
