// SPDX-License-Identifier: Apache-2.0
#include "tools/console/log_file.hpp"

#include "engine/run/error.hpp"
#include "tools/console/visible_text.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>

#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace lacuna::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPattern = "%Y-%m-%dT%H:%M:%S.%e%z %l: %v";
constexpr std::string_view kFirstWords = " info: lacuna ";

std::string& command_line() {
  static std::string line;
  return line;
}

// Messages hold names of files, which may hold line ends: each stays one line.
class LogFileSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit LogFileSink(const fs::path& file) : file_(file.string()) { file_.set_pattern(kPattern); }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const std::string text = visible({message.payload.data(), message.payload.size()});
    spdlog::details::log_msg shown = message;
    shown.payload = text;
    file_.log(shown);
    file_.flush();
  }
  void flush_() override { file_.flush(); }
  void set_pattern_(const std::string&) override {}
  void set_formatter_(std::unique_ptr<spdlog::formatter>) override {}

 private:
  spdlog::sinks::basic_file_sink_st file_;
};

// Never destroyed: other threads may log until the very end.
std::shared_ptr<spdlog::logger>& file_logger() {
  static auto* const logger = new std::shared_ptr<spdlog::logger>;
  return *logger;
}

// An empty file, or one that begins as kPattern and the first line of a run have it.
bool is_log(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string start(64, '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(in.gcount()));
  return start.empty() || (start.find(kFirstWords) < start.size() &&
                           start.find('\n') > start.find(kFirstWords) && start[4] == '-' && start[10] == 'T');
}

void check_log_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) {
    if (!fs::is_symlink(fs::symlink_status(file, error))) return;
    throw Error(file.string() + ": is a symbolic link to nothing; --log-file needs a new file or a log");
  }
  if (!fs::is_regular_file(status)) throw Error(file.string() + ": not a regular file; --log-file needs one");
  if (::access(file.c_str(), R_OK | W_OK) != 0)
    throw Error(file.string() + ": cannot be written to: " + std::strerror(errno));
  if (!is_log(file))
    throw Error(file.string() +
                ": exists, and is no log of lacuna; --log-file needs a new file or such a log");
}

}  // namespace

void remember_command_line(std::string_view version, int argc, char** argv) {
  command_line() = std::string(version) + ":";
  for (int i = 0; i < argc; ++i) command_line().append(" ").append(argv[i]);
}

void start_log_file(const fs::path& file) {
  check_log_file(file);
  std::shared_ptr<LogFileSink> sink;
  try {
    sink = std::make_shared<LogFileSink>(file);
  } catch (const spdlog::spdlog_ex& error) {
    throw Error(file.string() + ": cannot be opened: " + std::strerror(errno));
  }
  file_logger() = std::make_shared<spdlog::logger>("file", sink);
  file_logger()->info("{}", command_line());
  spdlog::default_logger()->sinks().push_back(sink);
}

void log_to_file(std::string_view line) {
  if (file_logger()) file_logger()->info("{}", line);
}

void log_error_to_file(std::string_view reason) {
  if (file_logger()) file_logger()->error("{}", reason);
}

}  // namespace lacuna::tools
