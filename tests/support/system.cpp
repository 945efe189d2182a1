// SPDX-License-Identifier: Apache-2.0
#include "tests/support/system.hpp"

#include <sys/wait.h>
#include <unistd.h>

namespace lacuna::test {
namespace {

// Waiting ends when the process that has made the gate opens it.
class Gate {
 public:
  Gate() {
    if (pipe(ends_) != 0) throw std::runtime_error("cannot make a pipe");
  }
  void wait() {
    close(ends_[1]);
    char byte = 0;
    while (read(ends_[0], &byte, 1) > 0) continue;
  }
  void open() { close(ends_[1]); }
  ~Gate() { close(ends_[0]); }

 private:
  int ends_[2];
};

pid_t fork_to(const std::function<void()>& act) {
  const pid_t child = fork();
  if (child != 0) return child;
  try {
    act();
  } catch (const std::exception&) {  // the test itself goes on in the other process alone
    _exit(1);
  }
  _exit(0);
}

}  // namespace

void do_apart(const std::function<void()>& act) {
  waitpid(fork_to(act), nullptr, 0);
}

std::size_t do_at_once(std::size_t processes,
                       const std::function<void(const std::function<void()>& wait)>& act) {
  Gate begin, end;
  for (std::size_t i = 0; i < processes; ++i) {
    fork_to([&] {
      begin.wait();
      act([&] { end.wait(); });
    });
  }
  begin.open();
  std::size_t failed = 0;
  const auto count = [&] {
    int status = 0;
    wait(&status);
    failed += status != 0;
  };
  for (std::size_t i = 0; i + 1 < processes; ++i) count();
  end.open();
  count();
  return processes - failed;
}

namespace {

struct OpenFile {
  fs::path entry;  // leads to the file though it has no name
  std::uint64_t size;
};

std::optional<OpenFile> find_open(pid_t process, const std::string& name) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(process) + "/fd", error)) {
    const std::string target = fs::read_symlink(entry.path(), error).string();
    if (fs::path(target.substr(0, target.find(" (deleted)"))).filename() != name) continue;
    const std::uintmax_t size = fs::file_size(entry.path(), error);
    if (!error && size > 0) return OpenFile{entry.path(), size};
  }
  return std::nullopt;
}

}  // namespace

bool has_open(pid_t process, const std::string& name) {
  return find_open(process, name).has_value();
}

bool cut_open_file(pid_t process, const std::string& name) {
  const std::optional<OpenFile> file = find_open(process, name);
  return file && ::truncate(file->entry.c_str(), static_cast<off_t>(file->size / 2)) == 0;
}

}  // namespace lacuna::test
