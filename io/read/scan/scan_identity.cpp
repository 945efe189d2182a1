// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/scan_identity.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <set>
#include <sstream>

#include <spdlog/fmt/fmt.h>

namespace lacuna::io {
namespace {

std::filesystem::path full_name(const std::filesystem::path& file) {
  return std::filesystem::absolute(file).lexically_normal();
}

std::string pose_text(const ScanFile& file) {
  std::ostringstream pose;
  if (file.pose) pose << file.pose->matrix().format(Eigen::IOFormat(17, Eigen::DontAlignCols, " ", " "));
  return pose.str();
}

}  // namespace

std::vector<std::string> identity_of(const ScanFiles& scan) {
  std::vector<std::string> lines;
  if (std::ranges::any_of(scan.files(), [](const ScanFile& file) { return file.arrays != nullptr; }))
    return lines;
  for (const ScanFile& file : scan.files()) {
    const Digest sample = sample_digest(file.name, file.state);
    lines.push_back(fmt::format("{}, {} bytes, written at {} ns, sample {:x}{:x}{}",
                                full_name(file.name).string(), file.state.size, file.state.mtime, sample[0],
                                sample[1], file.pose ? ", pose " + pose_text(file) : ""));
  }
  FilesConfig config;
  config.input = scan.config();
  for (const Parameter& p : file_parameters(config)) {
    if (p.changes == Changes::kPoints) lines.push_back(std::string(p.key) + " = " + p.print());
  }
  if (const std::string& crs = scan.stated_crs().crs; !crs.empty())  // a file counts by its content
    lines.push_back(fmt::format("text of crs = {:x}", digest_of(crs)[0]));
  return lines;
}

std::vector<std::string> kept_names(const ScanFiles& scan) {
  std::vector<std::string> names;
  for (const ScanFile& file : scan.files())
    names.insert(names.end(), {file.name.string(), full_name(file.name).string(), pose_text(file)});
  return names;
}

std::vector<ScanInput> inputs_of(std::span<const std::string> names) {
  std::vector<ScanInput> inputs;
  if (names.size() % 3 != 0) fail_inconsistent("an input of a workspace has no name");
  for (; !names.empty(); names = names.subspan(3)) {
    const std::string& file = full_name(names[0]) == names[1] ? names[0] : names[1];
    inputs.emplace_back(file, names[2].empty() ? std::nullopt : std::optional(parse_pose(names[2])));
  }
  return inputs;
}

std::vector<std::size_t> repeated_files(const ScanFiles& scan) {
  std::set<FileIdentity> seen;
  std::vector<std::size_t> repeated;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    const ScanFile& file = scan.files()[i];
    if (!file.arrays && !seen.emplace(file.state.device, file.state.inode).second) repeated.push_back(i);
  }
  return repeated;
}

void check_not_input(const ResultFolder& folder, const ScanFiles& scan) {
  for (const std::filesystem::path& earlier : folder.earlier_files()) {
    const std::optional<FileIdentity> identity = find_identity(earlier);
    for (const ScanFile& file : scan.files()) {
      if (!file.arrays && identity == FileIdentity(file.state.device, file.state.inode))
        throw Error(file.name.string() +
                    ": is an input in the place of a result; another output folder is needed");
    }
  }
}

}  // namespace lacuna::io
