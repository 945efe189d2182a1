// SPDX-License-Identifier: Apache-2.0
#include "engine/inspect.hpp"

#include "engine/config/job.hpp"
#include "engine/scan_steps.hpp"
#include "engine/summarise.hpp"

namespace lacuna {

Inspection inspect(PointSource& scan, const Config& given, const std::filesystem::path& temporary,
                   Progress& progress) {
  const Config config = effective(given);
  Job job(config, temporary, progress);
  const Parts nothing_kept;
  const Level level = first_level({scan, nothing_kept, job});
  return {.summary = summarise(level, job.workers),
          .cell_size = level.survey.grid.edge(),
          .cells = level.store.tiling().cells.size()};
}

}  // namespace lacuna
