// SPDX-License-Identifier: Apache-2.0
// A run of the engine for Python: its scan, its parameters, and what it has found.
#pragma once

#include "engine/store/temporary_folder.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/read/options/options.hpp"
#include "io/read/scan/scan_files.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

namespace lacuna::python {

// Sets parameters from a dict of their keys and values, both texts as on the command line. Throws `Error`.
void set_parameters(const pybind11::dict& values, io::FilesConfig& config);

struct Found {
  io::FilesConfig config;
  pybind11::object arrays;  // that the scan reads
  std::optional<io::ScanFiles> scan;
  std::unique_ptr<TemporaryFolder> scratch;
  std::optional<io::ExplainedDetection> detection;  // reads the scratch
  std::vector<std::string> warnings;
};

// Runs the engine on a thread of its own, without Python's lock. Meanwhile this thread calls progress(stage,
// share, seconds left) ten times a second, unless it is None, and Python's handlers of signals. A callback
// that returns False, or an exception of either, ends the run. It is called once more at the end. The files
// of the results are written to the folder `out`, if there is one. Throws `Error`, or that exception.
std::unique_ptr<Found> find(std::vector<io::ScanInput> inputs, io::FilesConfig config,
                            pybind11::object arrays, const pybind11::object& progress,
                            const std::optional<std::filesystem::path>& out = {});

// Checks whether the scan covers `config.area`, in the same way, and writes the voids to the folder. Returns
// warnings.
std::vector<std::string> check(std::vector<io::ScanInput> inputs, const io::FilesConfig& config,
                               const std::filesystem::path& folder, const pybind11::object& progress);

}  // namespace lacuna::python
