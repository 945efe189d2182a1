// SPDX-License-Identifier: Apache-2.0
// The commands of `lacuna`. Each function adds one to the program, with its options. The command runs when it
// is parsed. It throws `Error` when the job fails, and `UsageError` for options that are not possible.
#pragma once

namespace lacuna::tools {

class Command;

// From a scan to its holes.
void add_detect_command(const Command& program);
void add_info_command(const Command& program);

// What is made of results.
void add_report_command(const Command& program);
void add_render_command(const Command& program);
void add_compare_command(const Command& program);

// Where scanners should stand next, and where they stood.
void add_stations_command(const Command& program);
void add_find_stations_command(const Command& program);

// Runs that go on from a workspace.
void add_update_command(const Command& program);
void add_status_command(const Command& program);
void add_clean_command(const Command& program);

// Runs that several processes share, such as a job array of Slurm.
void add_plan_command(const Command& program);
void add_work_command(const Command& program);
void add_finish_command(const Command& program);

}  // namespace lacuna::tools
