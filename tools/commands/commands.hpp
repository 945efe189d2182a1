// SPDX-License-Identifier: Apache-2.0
// The commands of `lacuna`. Each function adds one to the program, with its options. The command runs when it
// is parsed. It throws `Error` when the job fails, and `UsageError` for options that are not possible.
#pragma once

#include "io/read/options/options.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace lacuna::tools {

class Command;

// These start with a scan.
void add_detect_command(const Command& program);
void add_info_command(const Command& program);
void add_check_command(const Command& program);

// These start with the results of a run.
void add_report_command(const Command& program);
void add_render_command(const Command& program);
void add_compare_command(const Command& program);

// These find places for scanners: the next ones, and the past ones.
void add_stations_command(const Command& program);

// Runs that go on from a workspace.
void add_status_command(const Command& program);
void add_clean_command(const Command& program);

// Runs that several processes share, such as a job array of Slurm.
void add_plan_command(const Command& program);
void add_work_command(const Command& program);
void add_finish_command(const Command& program);

// `lacuna info`: what scan files hold, and what a run on them would take.

// Returns what `lacuna info --json` prints. Its warnings take the place of `warnings`. Throws `Error`.
std::string info_json(const std::vector<std::filesystem::path>& scans, const io::FilesConfig& config,
                      std::vector<std::string>& warnings);

}  // namespace lacuna::tools
