// SPDX-License-Identifier: Apache-2.0
#include "io/report/report.hpp"

#include "io/report/match_marks.hpp"
#include "io/report/report_page.hpp"
#include "io/report/scene.hpp"

#include <utility>

namespace lacuna::io {

namespace fs = std::filesystem;

WrittenReport write_report(const fs::path& folder, Overwrite overwrite,
                           const std::optional<fs::path>& marks) {
  const fs::path file = folder / "report.html";
  check_output(file, kReportMark, overwrite);
  MatchedMarks matched;
  if (marks) matched.marks = read_marks(*marks);
  Scene scene = read_scene(folder);
  scene.next_stations = read_next_stations(folder);
  matched.matches = match_marks(matched.marks, scene.loops);
  OutputSet set(overwrite);
  write_report(scene, set.add(file, kReportMark), matched);
  set.commit();
  return {file, std::move(matched)};
}

}  // namespace lacuna::io
