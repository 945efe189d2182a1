// SPDX-License-Identifier: Apache-2.0
#include "python/run.hpp"

#include "engine/pipeline.hpp"
#include "engine/run/error.hpp"
#include "engine/run/memory.hpp"
#include "io/explain/area/check_area.hpp"
#include "io/explain/stations/find_causes.hpp"
#include "io/write/results/results.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/progress.hpp"
#include "tools/run/scan_warnings.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <iterator>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

namespace py = pybind11;

namespace lacuna::python {
namespace {

class Cancelled : public std::exception {};
constexpr const char* kCancelled = "the run was cancelled by its progress callback";

// Where the run stands, for the thread that Python knows.
class WatchedProgress final : public tools::CountedProgress {
 public:
  using CountedProgress::CountedProgress;

  void begin(std::string_view step, std::uint64_t total) override {
    stop_if_cancelled();
    CountedProgress::begin(step, total);
  }
  void advance(std::uint64_t count) override {
    CountedProgress::advance(count);
    stop_if_cancelled();
  }
  void cancel() { is_cancelled_ = true; }

 private:
  void stop_if_cancelled() const {
    if (is_cancelled_) throw Cancelled();
  }

  std::atomic<bool> is_cancelled_ = false;
};

// Work on a thread of its own.
class Worker {
 public:
  template <class Work>
  explicit Worker(Work work)
      : thread_([this, work = std::move(work)] {
          try {
            work();
          } catch (...) {
            error_ = std::current_exception();
          }
          const std::lock_guard lock(mutex_);
          is_done_ = true;
          done_.notify_all();
        }) {}

  bool wait() {  // a tenth of a second at most; true: it is done
    std::unique_lock lock(mutex_);
    return done_.wait_for(lock, std::chrono::milliseconds(100), [&] { return is_done_; });
  }
  std::exception_ptr join() {
    thread_.join();
    return error_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable done_;
  bool is_done_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

// Throws what a handler of a signal or the callback raises.
bool wants_more(const tools::StepProgress& state, const py::object& callback) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (callback.is_none() || state.step.empty()) return true;
  const auto or_none = [](std::optional<double> value) {
    return value ? py::object(py::cast(*value)) : py::object(py::none());
  };
  const py::object answer = callback(state.step, or_none(state.share()), or_none(state.seconds_left()),
                                     or_none(state.run_share), or_none(state.run_seconds_left()));
  return !answer.is(py::bool_(false));
}

template <class Work>
void run_watched(Work work, WatchedProgress& progress, const py::object& callback) {
  std::optional<py::error_already_set> raised;
  bool is_stopped = false;
  std::exception_ptr error;
  {
    const py::gil_scoped_release unlocked;
    Worker worker(std::move(work));
    while (!worker.wait()) {
      if (is_stopped) continue;
      const py::gil_scoped_acquire locked;
      try {
        is_stopped = !wants_more(progress.state(), callback);
      } catch (py::error_already_set& exception) {
        raised.emplace(exception);
        is_stopped = true;
      }
      if (is_stopped) progress.cancel();
    }
    error = worker.join();
  }
  if (!raised && !error && !wants_more(progress.state(), callback)) throw Error(kCancelled);  // a short run
  if (raised) throw py::error_already_set(*raised);
  if (!error) return;
  try {
    std::rethrow_exception(error);
  } catch (const Cancelled&) {
    throw Error(kCancelled);
  }
}

}  // namespace

void set_parameters(const py::dict& values, io::FilesConfig& config) {
  const std::vector<Parameter> all = parameters(config);
  for (const auto& [key, value] : values) {
    const auto name = key.cast<std::string>();
    const auto at = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.key == name; });
    if (at == all.end()) throw Error("no parameter has the name " + name);
    at->set(value.cast<std::string>());
  }
}

std::unique_ptr<Found> find(std::vector<io::ScanInput> inputs, io::FilesConfig config, py::object arrays,
                            const py::object& progress, const std::optional<std::filesystem::path>& out) {
  auto found = std::make_unique<Found>();
  found->config = with_min_hole(config);
  found->arrays = std::move(arrays);
  WatchedProgress watched(tools::steps_of_run(config));
  run_watched(
      [&] {
        check_config(config);
        found->scan.emplace(std::move(inputs), config.input, Memory::share(config.run.memory_limit).reading);
        tools::require_lengths(*found->scan);
        found->warnings = tools::input_warnings(*found->scan);
        std::optional<io::ResultFolder> results;  // it is refused before the work
        if (out) io::check_results(*found->scan, config, results.emplace(*out));
        found->scratch =
            std::make_unique<TemporaryFolder>(temporary_parent(config.run.scratch), kScratchPrefix);
        const auto stations = io::watch_stations(*found->scan, config.output, found->scratch->path());
        io::ScanPass pass(*found->scan, stations.get());
        const auto detected = detect(pass, config, found->scratch->path(), watched);
        found->detection.emplace(*detected, pass.counts());
        if (stations) io::find_causes(*stations, config.run, *found->detection);
        const io::ExplainedDetection& detection = *found->detection;
        std::ranges::copy(
            tools::station_warnings(detection.stations, detection.points_of_none, detection.upward),
            std::back_inserter(found->warnings));
        std::ranges::copy(tools::scan_warnings(*found->scan, detection, config),
                          std::back_inserter(found->warnings));
        if (!results) return;
        watched.begin("write", 0);
        io::write_results(detection, *found->scan, found->config, *results);
        watched.end();
      },
      watched, progress);
  return found;
}

std::vector<std::string> check(std::vector<io::ScanInput> inputs, const io::FilesConfig& given,
                               const std::filesystem::path& folder, const py::object& progress) {
  std::vector<std::string> warnings;
  WatchedProgress watched(tools::steps_of_check());
  run_watched(
      [&] {
        io::FilesConfig config = given;
        config.area.is_check = true;
        check_config(config);
        const io::ScanFiles scan(std::move(inputs), config.input,
                                 Memory::share(config.run.memory_limit).reading);
        tools::require_lengths(scan);
        warnings = tools::input_warnings(scan);
        const io::AreaCheck checked = io::check_scan(scan, config, watched);
        std::ranges::copy(tools::area_warnings(checked, scan.length_unit()), std::back_inserter(warnings));
        io::ResultFolder results(folder);
        io::write_voids(checked, scan, config, results);
      },
      watched, progress);
  return warnings;
}

}  // namespace lacuna::python
