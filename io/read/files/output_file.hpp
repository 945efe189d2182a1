// SPDX-License-Identifier: Apache-2.0
// A file that is being written, through one buffer or by another library. Every failure of the disk is an
// `Error` with the file's name.
#pragma once

#include "engine/export.hpp"
#include "engine/store/temporary_folder.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

// The writer of the bytes: this class, or a library that makes the file, or makes none.
enum class Writer { kThis, kLibrary };

class OutputFile {
 public:
  // Makes the new file `place`, or leaves that to the library. Errors call it `name`: the path that it will
  // have in the end.
  OutputFile(std::filesystem::path name, const std::filesystem::path& place, Writer writer = Writer::kThis);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& path() const { return name_; }
  const std::filesystem::path& place() const { return place_; }

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  // Puts bytes over the written bytes from `at` on, such as a count known at the end.
  void overwrite(std::uint64_t at, std::span<const std::byte> bytes);
  void overwrite_start(std::string_view text) { overwrite(0, std::as_bytes(std::span(text))); }

  // Afterwards all bytes are on the disk, and nothing can be written any more. Returns false if the library
  // has made no file.
  bool close();

 private:
  void flush();
  void put(std::uint64_t at, std::span<const std::byte> bytes);
  [[noreturn]] void fail(const char* what, int reason) const;

  std::filesystem::path name_, place_;
  Writer writer_;
  int descriptor_ = -1;
  std::uint64_t end_ = 0;  // of what is in the file; the buffer follows
  std::vector<std::byte> buffer_;
};

// A file that takes its name only once it is complete.
//
// The name may be free, or the name of an own file: a regular file that the same command has written, which
// its mark shows. With Overwrite::kAny it may be the name of any regular file. Links, folders, pipes and
// devices are refused. The content goes to a private folder next to the name first. A failure leaves the name
// as it was.

enum class Overwrite { kOwn, kAny };

// The proof that an earlier run of a command wrote a file: a text at a byte of it.
struct FileMark {
  FileMark(std::string_view text, std::uint64_t offset = 0) : text(text), offset(offset) {}
  FileMark(const char* text) : text(text) {}

  std::string_view text;
  std::uint64_t offset = 0;
};

// Throws `Error` if a file of this name may not be written. Cheap, for a program to check before the work.
void check_output(const std::filesystem::path& file, const FileMark& mark, Overwrite overwrite);

class NewFile {
 public:
  // Checks the name, and opens the content.
  NewFile(const std::filesystem::path& file, const FileMark& mark, Overwrite overwrite);

  OutputFile& content() { return content_; }

  // Closes the content, and gives it the name. Throws `Error` if a file has come to the name meanwhile that
  // may not be replaced.
  void commit();

 private:
  std::filesystem::path file_;
  FileMark mark_;
  Overwrite overwrite_;
  TemporaryFolder folder_;
  OutputFile content_;
};

// A folder of results that takes its name as a whole, or not at all.
//
// 1. A name may be free, or the name of an empty folder, or of an *earlier result*: a folder whose list,
//    `.lacuna`, names all of its files. A folder that holds anything else is refused, and so is a link to no
//    folder.
// 2. Files are written to a temporary folder next to it, `.NAME.lacuna-` and drawn digits. A run that sees
//    the one of another process is refused. What a killed run has left there goes with the next run.
// 3. commit: the list is added, and all files are brought to the disk. Then one rename gives the folder its
//    name. An earlier result changes places with the new one, and is removed.
//
// A crash leaves the earlier result whole, or the new one. On a file system that cannot exchange two names,
// the earlier result moves to the temporary folder first. If the run is killed then, the next one puts it
// back before anything else.

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
