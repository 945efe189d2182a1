// SPDX-License-Identifier: Apache-2.0
// lacuna._core: what python/lacuna calls. Everything else is Python.
#include "bench/evaluation/evaluation.hpp"
#include "engine/run/error.hpp"
#include "io/read/files/output_file.hpp"
#include "io/write/report/report.hpp"
#include "io/write/report/scene.hpp"
#include "io/write/results/results.hpp"
#include "python/arrays.hpp"
#include "python/command.hpp"
#include "python/run.hpp"
#include "tools/commands/commands.hpp"
#include "tools/commands/compare_command.hpp"
#include "tools/run/input_files.hpp"

#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace py = pybind11;
namespace fs = std::filesystem;

namespace lacuna::python {
namespace {

std::unique_ptr<Found> find_in_arrays(const py::dict& columns, const py::dict& parameters,
                                      const py::object& progress) {
  io::FilesConfig config;
  set_parameters(parameters, config);
  std::vector<io::ScanInput> inputs;
  inputs.emplace_back("arrays", scan_of(columns));
  return find(std::move(inputs), config, columns, progress);
}

std::unique_ptr<Found> find_in_files(const std::vector<fs::path>& files, const py::dict& parameters,
                                     const py::object& progress, const std::optional<fs::path>& out) {
  io::FilesConfig config;
  set_parameters(parameters, config);
  return find(tools::expand_inputs(files, config), config, py::none(), progress, out);
}

std::vector<std::string> check_files(const std::vector<fs::path>& files, const py::dict& parameters,
                                     const fs::path& folder, const py::object& progress) {
  io::FilesConfig config;
  set_parameters(parameters, config);
  return in_python_words(check(tools::expand_inputs(files, config), config, folder, progress));
}

// Returns the JSON, and warnings.
std::pair<std::string, std::vector<std::string>> info(const std::vector<fs::path>& files,
                                                      const py::dict& parameters) {
  io::FilesConfig config;
  set_parameters(parameters, config);
  check_config(config);
  const py::gil_scoped_release unlocked;
  std::vector<std::string> warnings;
  std::string json = tools::info_json(files, config, warnings);
  return {std::move(json), in_python_words(warnings)};
}

// Names, defaults and what is allowed, of the parameters of a run, a check or an info.
py::list list_parameters(const std::string& command) {
  const tools::ReadParameters read = command == "check"  ? tools::parameters_of_check()
                                     : command == "info" ? tools::parameters_of_info()
                                                         : tools::parameters_of_run();
  io::FilesConfig config;
  py::list all;
  for (const Parameter& parameter : parameters(config)) {
    if (!read.has(parameter)) continue;
    py::dict one;
    one["section"] = parameter.section;
    one["key"] = parameter.key;
    one["default"] = parameter.print();
    one["allowed"] = parameter.allowed;
    one["help"] = parameter.help;
    all.append(one);
  }
  return all;
}

std::vector<fs::path> save(Found& found, const fs::path& folder, const py::dict& parameters) {
  io::FilesConfig config = found.config;
  set_parameters(parameters, config);
  const py::gil_scoped_release unlocked;
  return io::write_results(*found.detection, *found.scan, config, folder);
}

// visit(block) in ascending id.
void for_each_block(const Found& found, const py::function& visit) {
  found.detection->for_each_result_block(
      [&](PointId first, std::span<const PointResult> block) { visit(block_of(first, block)); });
}

void write_report(const fs::path& folder, const fs::path& file) {
  const py::gil_scoped_release unlocked;
  io::NewFile out(file, io::kReportMark, io::Overwrite::kOwn);
  io::Scene scene = io::read_scene(folder);
  scene.next_stations = io::read_next_stations(folder);
  io::write_report(scene, out.content());
  out.commit();
}

std::vector<fs::path> copy_results(const fs::path& from, const fs::path& to) {
  const py::gil_scoped_release unlocked;
  return io::copy_results(from, to);
}

std::string evaluate(const fs::path& result_path, const fs::path& truth_path,
                     const std::vector<fs::path>& scans, double tolerance, std::size_t min_vertices) {
  const py::gil_scoped_release unlocked;
  evaluation::Result result = evaluation::read_result(result_path);
  const evaluation::Truth truth = evaluation::read_truth(truth_path, {scans.begin(), scans.end()}, result);
  const evaluation::EvaluationRule rule{.tolerance = tolerance, .min_vertices = min_vertices};
  const evaluation::Evaluation evaluation = evaluation::evaluate(result, truth, rule);
  return evaluation::print_json({result, truth, evaluation, result_path, truth_path, rule});
}

// Returns the comparison as JSON, and warnings.
std::pair<std::string, std::vector<std::string>> compare(const fs::path& before, const fs::path& after,
                                                         double tolerance) {
  const py::gil_scoped_release unlocked;
  const tools::Comparison comparison(tools::read_result(before), tools::read_result(after), tolerance);
  return {comparison.json().dump(), in_python_words(comparison.warnings)};
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.attr("version") = LACUNA_VERSION;
  collect_warnings();
  static auto* const raise = new py::exception<Error>(module, "Error", PyExc_RuntimeError);
  raise->attr("__module__") = "lacuna";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      (*raise)(in_python_words(error.what()).c_str());
    }
  });

  py::class_<Found>(module, "Found")
      .def_property_readonly("warnings", [](const Found& f) { return in_python_words(f.warnings); })
      .def_property_readonly("has_points", [](const Found& f) { return f.config.results.points; })
      .def_property_readonly("unit", [](const Found& f) { return f.scan->length_unit(); })
      .def_property_readonly("crs", [](const Found& f) { return f.scan->common_crs(); })
      .def("summary", [](const Found& f) { return summary_of(*f.detection); })
      .def("loops", [](const Found& f) { return loops_of(*f.detection); })
      .def("points", [](const Found& f) { return points_of(*f.detection); })
      .def("sample", [](const Found& f) { return sample_of(*f.detection); })
      .def("for_each_block", &for_each_block)
      .def("save", &save);

  module.def("parameters", &list_parameters, py::arg("command"));
  module.def("find_in_arrays", &find_in_arrays);
  module.def("find_in_files", &find_in_files);
  module.def("check_files", &check_files);
  module.def("info", &info);
  module.def("run_command", &run_command);
  module.def("write_report", &write_report);
  module.def("copy_results", &copy_results);
  module.def("evaluate", &evaluate);
  module.def("compare", &compare);
}

}  // namespace lacuna::python
