// SPDX-License-Identifier: Apache-2.0
#include "python/command.hpp"

#include "tools/commands/commands.hpp"
#include "tools/console/command_line.hpp"

#include <algorithm>
#include <iostream>
#include <memory>
#include <mutex>
#include <regex>
#include <sstream>
#include <streambuf>

#include <pybind11/pybind11.h>
#include <spdlog/details/null_mutex.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

namespace lacuna::python {
namespace {

thread_local std::vector<std::string> warnings;  // of the command of this thread

class Warnings final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (message.level >= spdlog::level::warn)
      warnings.emplace_back(message.payload.data(), message.payload.size());
  }
  void flush_() override {}
};

// Takes what the program prints for people, for as long as it lives.
class SilentOutput {
 public:
  SilentOutput() : console_(std::cout.rdbuf(text_.rdbuf())) {}
  ~SilentOutput() { std::cout.rdbuf(console_); }
  SilentOutput(const SilentOutput&) = delete;
  SilentOutput& operator=(const SilentOutput&) = delete;

 private:
  std::ostringstream text_;
  std::streambuf* console_;
};

}  // namespace

void collect_warnings() {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("lacuna", std::make_shared<Warnings>()));
}

std::string in_python_words(const std::string& text) {
  static const std::regex hint(R"( \(see [^)]* --help\))"),
      command(R"(\blacuna (detect|check|info|stations)\b)"),
      option("(^|[^a-z-])--([a-z][a-z-]*)(?![a-z.-])");  // none of other programs, such as --filters.range
  const std::string plain = std::regex_replace(std::regex_replace(text, hint, ""), command, "lacuna.$1");
  std::string words;
  std::size_t end = 0;
  for (std::sregex_iterator at(plain.begin(), plain.end(), option); at != std::sregex_iterator(); ++at) {
    std::string name = (*at)[2];
    std::ranges::replace(name, '-', '_');
    const auto begin = static_cast<std::size_t>(at->position());
    words.append(plain, end, begin - end).append((*at)[1]).append(name);
    end = begin + static_cast<std::size_t>(at->length());
  }
  return words.append(plain, end);
}

std::vector<std::string> in_python_words(const std::vector<std::string>& texts) {
  std::vector<std::string> words;
  for (const std::string& text : texts) words.push_back(in_python_words(text));
  return words;
}

std::vector<std::string> run_command(const std::vector<std::string>& arguments) {
  static std::mutex one_at_a_time;
  const pybind11::gil_scoped_release unlocked;
  const std::lock_guard lock(one_at_a_time);
  const SilentOutput silence;
  tools::CommandLine line("lacuna", "", "");
  tools::add_render_command(line.program());
  tools::add_stations_command(line.program());
  warnings.clear();
  line.run(arguments);
  return in_python_words(std::exchange(warnings, {}));
}

}  // namespace lacuna::python
