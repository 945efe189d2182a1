// SPDX-License-Identifier: Apache-2.0
// A folder of results that takes its name as a whole, or not at all.
//
// 1. A name may be free, or the name of an empty folder, or of an *earlier result*: a folder whose list,
//    `.lacuna`, names all of its files. A folder that holds anything else is refused, and so is a link to no
//    folder.
// 2. Files are written to a temporary folder next to it, `.NAME.lacuna-` and drawn digits. A run that sees
//    the one of another process is refused. What a killed run has left there goes with the next run.
// 3. commit: the list is added, and all files are brought to the disk. Then one rename gives the folder its
//    name. An earlier result changes places with the new one, and is removed. A file that came to it after
//    the last look goes to the new result.
//
// A crash leaves the earlier result whole, or the new one. On a file system that cannot exchange two names,
// the earlier result moves to the temporary folder first. If the run is killed then, the next one puts it
// back before anything else.
#pragma once

#include "engine/export.hpp"
#include "engine/store/temporary_folder.hpp"
#include "io/read/files/output_file.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lacuna::io {

class ResultFolder {
 public:
  // Makes missing parents of the folder. Throws `Error` if the name may not be taken, or if another run
  // writes results of this name.
  LACUNA_API explicit ResultFolder(const std::filesystem::path& folder);
  LACUNA_API ~ResultFolder();

  const std::filesystem::path& path() const { return folder_; }  // as it was given
  std::filesystem::path staged() const { return temporary() / "results"; }
  // For temporary files: they go with this object.
  const std::filesystem::path& temporary() const { return temporary_->path(); }
  // Returns the files of the earlier result that are replaced.
  std::vector<std::filesystem::path> earlier_files() const;

  // Opens a new file of this name, such as "holes.csv" or "points/a.ply". The caller closes it before commit.
  std::unique_ptr<OutputFile> open(const std::string& name, Writer writer = Writer::kThis) const;
  // Opens the file, lets `write` fill it, and closes it. From several threads, for different files.
  void add(const std::string& name, const std::function<void(OutputFile& out)>& write,
           Writer writer = Writer::kThis) const;

  // Returns the files at the top of the folder, and its subfolders, in the order of their names. Throws
  // `Error`; then the folder is as it was.
  std::vector<std::filesystem::path> commit();

 private:
  std::filesystem::path folder_, target_;  // `target_`: absolute, without links
  std::optional<TemporaryFolder> temporary_;
};

// Returns whether a folder has results: a list, and a file that it names.
bool is_result_folder(const std::filesystem::path& folder);

// Copies the results of a folder to another one, as a run writes them there. Returns as commit does.
std::vector<std::filesystem::path> copy_results(const std::filesystem::path& from,
                                                const std::filesystem::path& to);

// A later command writes this file to the folder, too. Adds the name to the list of the folder, if it has
// one.
void note_result(const std::filesystem::path& folder, const std::string& name);

}  // namespace lacuna::io
