// SPDX-License-Identifier: Apache-2.0
#include "engine/parts/parts.hpp"

#include "engine/parts/kept_run.hpp"
#include "engine/run/error.hpp"

#include <system_error>

namespace lacuna {
namespace fs = std::filesystem;

std::string line_of(const Digest& checksum) {
  return "part " + std::to_string(checksum[0]) + " " + std::to_string(checksum[1]) + "\n";
}

std::string PartKey::text() const {
  return "step " + step + "\n" + made_from + "share " + std::to_string(share.task) + " of " +
         std::to_string(share.tasks) + "\n";
}

std::optional<std::string> Parts::seal_of(const PartKey& key) const {
  const std::optional<PartReader> part = open(key);
  return part ? std::optional(line_of(part->checksum())) : std::nullopt;
}

void Parts::show_if_replaced(const PartKey& key) const {
  std::error_code error;
  if (fs::exists(file_of(key), error)) progress->make_again(key.step);
}

void Parts::drop(const std::string& step) const {
  for (const fs::path& file : kept_files(folder)) {
    if (is_of_step(file, step)) remove_kept(file);
  }
}

std::optional<PartReader> Parts::open(const PartKey& key) const {
  if (!are_kept()) return std::nullopt;
  return PartReader::open(file_of(key), key.text());
}

fs::path Parts::file_of(const PartKey& key) const {
  return part_file(folder, key.step, std::to_string(key.share.task));
}

// A task whose level is whole drops the parts that led to it, also those that another task has just sealed.
void Parts::fail_replaced(const fs::path& file) const {
  if (!fs::exists(file)) throw DamagedFile(file);  // so the work begins again
  throw Error(folder.string() +
              ": another process has replaced parts of it; the same command goes on from there");
}

}  // namespace lacuna
