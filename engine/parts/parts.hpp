// SPDX-License-Identifier: Apache-2.0
// The parts of a run: what its steps have made, each kept under its key, from which the same run goes on.
//
// A key is the step, its share, and all that the part was made from. A kept part is a file that says so by
// itself (store/sealed_part.hpp). So nothing lists what is done, and parts of other inputs or parameters are
// never mixed. Several processes may make parts at a time: two parts of one key have the same content.
#pragma once

#include "engine/model/task_share.hpp"
#include "engine/run/progress.hpp"
#include "engine/store/sealed_part.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna {

struct PartKey {
  std::string step;  // "survey", "level-0"
  TaskShare share;
  std::string made_from;  // a line each

  std::string text() const;  // the step, what the part was made from, and its share
};

// Why a part is made.
struct Reason {
  enum class Why : std::uint8_t {
    kNew,        // it was not there
    kUnusable,   // it is there, without its columns, or with tiles that do not fit in memory
    kDamaged,    // its bytes are not those that were sealed
    kInput,      // a file of the input has changed
    kParameter,  // a parameter has changed
    kFollows,    // a step before it has changed
  };
  Why why = Why::kNew;
  std::string was, is;  // the first line that has changed

  std::string words() const;  // "damaged", "\"k = 15\" is \"k = 20\" now"
};

// Returns why a part is made that a file should have, from `made_from`.
Reason reason_of(const std::filesystem::path& file, const std::string& made_from);

// How several processes share a run.
struct TaskPlan {
  std::size_t tasks = 1;          // of each step that is shared
  std::size_t levels = 0;         // whose steps are shared, from the first level on
  std::uint64_t tile_points = 0;  // of each task's tiles, at most
  bool reads = false;             // whether reading the scan is shared

  std::size_t tasks_of_level(std::size_t level) const {
    return level < levels && (level > 0 || reads) ? tasks : 1;
  }
};

// The kept parts of a run. A form says how a value becomes a part. read(part) returns the value, or nothing
// where it cannot be used here. write(value, writer) writes it.
struct Parts {
  std::filesystem::path folder;  // the kept folder; empty: nothing is kept
  std::string made_from;         // input and parameters of the points, a line each
  TaskPlan plan;
  bool is_unit = false;          // one of several processes that make parts of the run: it removes none
  Progress* progress = nullptr;  // hears why a part is made again

  bool are_kept() const { return !folder.empty(); }

  // Returns the part with this key: the kept one, or what make() returns, which is kept then.
  template <class Form, class Make>
  auto get(const PartKey& key, const Form& form, Make&& make) const {
    auto found = find(key, form);
    return found ? *std::move(found) : keep(key, form, make());
  }
  // Returns the kept part with this key. It is empty where there is none.
  template <class Form>
  auto find(const PartKey& key, const Form& form) const {
    using Found = decltype(form.read(std::declval<PartReader>()));
    std::optional<PartReader> part = open(key);
    return part ? form.read(*std::move(part)) : Found();
  }
  // Seals a value that was made, and returns it as the part has it. Where nothing is kept, returns it as it
  // is.
  template <class Form, class Value>
  Value keep(const PartKey& key, const Form& form, Value made) const {
    if (!are_kept()) return made;
    write(key, form, std::move(made));
    auto kept = find(key, form);
    if (!kept) fail_replaced(file_of(key));
    return *std::move(kept);
  }

  // Returns the checksum of a kept part as a line of what another part is made from.
  std::optional<std::string> seal_of(const PartKey& key) const;
  // Lets the progress show why a part is made again, unless that follows from a step before.
  void show(const std::string& step, const Reason& reason) const;
  // Removes the kept parts of a step.
  void drop(const std::string& step) const;

 private:
  std::optional<PartReader> open(const PartKey& key) const;
  std::filesystem::path file_of(const PartKey& key) const;
  template <class Form, class Value>
  void write(const PartKey& key, const Form& form, Value made) const {
    show(key.step, reason_of(file_of(key), key.text()));
    PartWriter part(file_of(key));
    form.write(made, part);
    part.seal(key.text());
  }
  [[noreturn]] void fail_replaced(const std::filesystem::path& file) const;
};

// Returns a checksum as a line.
std::string line_of(const Digest& checksum);

inline constexpr const char* kRunPart = "run.lacuna";  // the part that says whose folder it is
bool is_kept_folder(const std::filesystem::path& folder);
bool is_kept_name(const std::filesystem::path& file);  // whether it could be of a kept folder

// Returns the parts of a text, each of which ends with `end`.
std::vector<std::string> split(std::string_view text, char end);
// Returns the first line of each text that the other one does not have.
std::pair<std::string, std::string> first_difference(const std::string& was, const std::string& is);

// The names of files in a kept folder. STEP-TASK.lacuna is a part. A column of a level has digits in place of
// the task, and its kind before the ending.
std::filesystem::path part_file(const std::filesystem::path& folder, const std::string& step,
                                const std::string& task);
// Returns the files of a kept folder, without others in it. A part proves what the folder is; the run's own
// may be missing, where a process was at work while the folder was cleaned. Returns nothing where it is none.
std::vector<std::filesystem::path> kept_files(const std::filesystem::path& folder);
// Returns whether a file belongs to a step: "level-0".
bool is_of_step(const std::filesystem::path& file, const std::string& step);
// Removes one of the files.
void remove_kept(const std::filesystem::path& file);

// Does the work of a run. Where it finds a damaged file, it removes the file and begins again: what the file
// had is made anew.
template <class Work>
auto without_damaged_files(Work&& work) {
  constexpr int kMostDamaged = 1000;  // more are a broken disk
  for (int damaged = 0;; ++damaged) {
    try {
      return work();
    } catch (const DamagedFile& error) {
      if (damaged == kMostDamaged) throw;
      remove_kept(error.file());
    }
  }
}

}  // namespace lacuna
