// SPDX-License-Identifier: Apache-2.0
#include "engine/parts/parts.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <regex>
#include <system_error>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChecksum = "part ";  // how a line begins that has one

// Returns the first of `lines` that is not among `others`.
std::string first_other(const std::vector<std::string>& lines, const std::vector<std::string>& others) {
  const auto is_other = [&](const std::string& line) { return std::ranges::count(others, line) == 0; };
  const auto found = std::ranges::find_if(lines, is_other);
  return found == lines.end() ? "nothing" : *found;
}

}  // namespace

std::string PartKey::text() const {
  return "step " + step + "\n" + made_from + "share " + std::to_string(share.task) + " of " +
         std::to_string(share.tasks) + "\n";
}

std::string Reason::words() const {
  switch (why) {
    case Why::kNew:
      return "new";
    case Why::kUnusable:
      return "its files are incomplete, or its tiles too large";
    case Why::kDamaged:
      return "damaged";
    case Why::kFollows:
      return "a step before it has changed";
    case Why::kInput:
    case Why::kParameter:
      break;
  }
  return "\"" + was + "\" is \"" + is + "\" now";
}

std::optional<std::string> Parts::seal_of(const PartKey& key) const {
  const std::optional<PartReader> part = open(key);
  return part ? std::optional(line_of(part->checksum())) : std::nullopt;
}

Reason reason_of(const fs::path& file, const std::string& made_from) {
  using Why = Reason::Why;
  std::error_code error;
  if (!fs::exists(file, error)) return {Why::kNew, "", ""};
  const std::optional<PartReader> part = PartReader::open(file, std::nullopt);
  const std::optional<std::string> before = part ? part->made_from() : std::nullopt;
  if (!before) return {Why::kDamaged, "", ""};
  if (*before == made_from) return {Why::kUnusable, "", ""};
  auto [was, is] = first_difference(*before, made_from);
  const Why why = is.starts_with(kChecksum)  ? Why::kFollows
                  : is.starts_with("input:") ? Why::kInput
                                             : Why::kParameter;
  return {why, std::move(was), std::move(is)};
}

void Parts::show(const std::string& step, const Reason& reason) const {
  if (reason.why != Reason::Why::kNew && reason.why != Reason::Why::kFollows)
    progress->make_again(step, reason.words());
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

std::string line_of(const Digest& checksum) {
  return kChecksum + std::to_string(checksum[0]) + " " + std::to_string(checksum[1]) + "\n";
}

bool is_kept_name(const fs::path& file) {
  static const std::regex names(
      "(run|plan|(survey|tiles|bucket|level|evaluate|loops)(-[0-9]+)?-[0-9a-f]+(\\.points|\\.normals)?)"
      "\\.lacuna(\\.[0-9a-f]{16})?(\\.partial)?");
  return std::regex_match(file.filename().string(), names);
}

std::vector<std::string> split(std::string_view text, char end) {
  std::vector<std::string> parts;
  for (std::size_t at; (at = text.find(end)) != std::string_view::npos; text.remove_prefix(at + 1))
    parts.emplace_back(text.substr(0, at));
  return parts;
}

std::pair<std::string, std::string> first_difference(const std::string& was, const std::string& is) {
  const std::vector<std::string> before = split(was, '\n'), now = split(is, '\n');
  return {first_other(before, now), first_other(now, before)};
}

bool is_kept_folder(const fs::path& folder) {
  return !kept_files(folder).empty();
}

fs::path part_file(const fs::path& folder, const std::string& step, const std::string& task) {
  return folder / (step + "-" + task + ".lacuna");
}

std::vector<fs::path> kept_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;  // a folder that is missing keeps nothing
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (fs::is_regular_file(entry.symlink_status()) && is_kept_name(entry.path()))
      files.push_back(entry.path());
  }
  if (!PartReader::is_part(folder / kRunPart) && std::ranges::none_of(files, PartReader::is_part))
    files.clear();
  std::sort(files.begin(), files.end());
  return files;
}

bool is_of_step(const fs::path& file, const std::string& step) {
  return file.filename().string().starts_with(step + "-");
}

void remove_kept(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) throw Error(file.string() + ": cannot be removed: " + error.message());
}

}  // namespace lacuna
