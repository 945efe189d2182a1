// SPDX-License-Identifier: Apache-2.0
// The parts of a run: what its steps have made, each kept under its key, from which the same run goes on.
//
// A key is the step, its share, and all that the part was made from. A kept part is a file that says so by
// itself (store/sealed_part.hpp). So nothing lists what is done, and parts of other inputs or parameters are
// never mixed. Several processes may make parts at a time: two parts of one key have the same content.
#pragma once

#include "engine/model/points.hpp"
#include "engine/model/task_share.hpp"
#include "engine/run/progress.hpp"
#include "engine/store/sealed_part.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace lacuna {

// Returns a checksum as a line of what another part is made from.
std::string line_of(const Digest& checksum);

struct PartKey {
  std::string step;  // "survey", "level-0"
  TaskShare share;
  std::string made_from;  // a line each

  std::string text() const;  // the step, what the part was made from, and its share
};

// The kept parts of a run. A form says how a value becomes a part. read(part) returns the value, or nothing
// where it cannot be used here. write(value, writer) writes it.
struct Parts {
  std::filesystem::path folder;  // the kept folder; empty: nothing is kept
  std::string made_from;         // input and parameters of the points, a line each
  SourceParts source;            // empty where nothing is kept
  TaskPlan plan;
  bool is_unit = false;          // one of several processes that make parts of the run: it removes none
  Progress* progress = nullptr;  // hears which step is made again

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
  // Removes the kept parts of a step.
  void drop(const std::string& step) const;

 private:
  std::optional<PartReader> open(const PartKey& key) const;
  std::filesystem::path file_of(const PartKey& key) const;
  template <class Form, class Value>
  void write(const PartKey& key, const Form& form, Value made) const {
    show_if_replaced(key);
    PartWriter part(file_of(key));
    form.write(made, part);
    part.seal(key.text());
  }
  // Lets the progress show that the step is made again, where its file is there.
  void show_if_replaced(const PartKey& key) const;
  [[noreturn]] void fail_replaced(const std::filesystem::path& file) const;
};

}  // namespace lacuna
