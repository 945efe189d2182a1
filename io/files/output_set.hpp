// SPDX-License-Identifier: Apache-2.0
// Files that appear under their names all together, or not at all.
//
// 1. add: the name is checked. It may be free, or the name of an *own file*: a regular file that has the mark
//    of the same command. With Overwrite::kAny it may be the name of any regular file. Links, folders, pipes
//    and devices are always refused.
// 2. The content goes to a new file in a private folder next to the name, `.lacuna-XXXXXX/new`. Other names
//    in the output folder are neither used nor examined. A file that is closed may be read there. The files
//    of a subfolder have their new and old places there, too: `.lacuna-XXXXXX/new/SUBFOLDER/`.
// 3. commit: all files are closed and on the disk before any name changes. Then older files move to
//    `.lacuna-XXXXXX/old`, last added first; new ones take their names in the order of add. So the last file
//    stands for all the others. The folders are synced, and the private ones go, with the older files.
//    Subfolders are made before new files take their names. One that is empty after older files have gone is
//    removed.
//
// Only the file that was checked is replaced. commit refuses another one that has come to its name meanwhile.
// A failure leaves the names as they were: in 3, new files are taken back and older ones return. An older
// file that cannot return stays in the private folder, and the error says where. A signal removes the private
// folders; it waits while 3 is under way. After SIGKILL or a power cut the private folder stays. Each older
// file is then under its name or in that folder.
#pragma once

#include "engine/store/temporary_folder.hpp"
#include "io/files/output_file.hpp"

#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <sys/stat.h>

namespace lacuna::io {

enum class Overwrite { kOwn, kAny };

// The proof that an earlier run of the command wrote a file: a text at a byte of it.
struct FileMark {
  FileMark(std::string_view text, std::uint64_t offset = 0) : text(text), offset(offset) {}
  FileMark(const char* text) : text(text) {}
  FileMark(std::string_view text, bool (*fits)(std::string_view)) : text(text), fits(fits) {}

  // Anywhere in the first line, which ends within 1 MiB.
  static constexpr std::uint64_t kInFirstLine = UINT64_MAX;
  // First bytes of the file that `fits` has at most.
  static constexpr std::size_t kReach = 128 * 1024;

  std::string_view text;
  std::uint64_t offset = 0;
  bool (*fits)(std::string_view first_bytes) = nullptr;  // and these fit, where more is to be checked
};

// Whether `file` is a regular file with the mark.
bool is_own_file(const std::filesystem::path& file, const FileMark& mark);

// Throws `Error` if a file of this name may not be written. Cheap, for a program to check before the work.
void check_output(const std::filesystem::path& file, const FileMark& mark, Overwrite overwrite);

// Throws `Error` if files may not be written to this subfolder, because the name is not a folder's.
void check_subfolder(const std::filesystem::path& folder);

// Returns the names in the folder, in no order; nothing if it is a link or does not exist. Throws `Error`.
std::vector<std::string> names_in(const std::filesystem::path& folder);

class OutputSet {
 public:
  explicit OutputSet(Overwrite overwrite) : overwrite_(overwrite) {}

  // Checks the name and opens the file. The reference is valid as long as the set. A library must make its
  // file at the OutputFile's place before commit, and have closed it. Where it makes none, the file that has
  // the name is removed.
  OutputFile& add(const std::filesystem::path& file, const FileMark& mark, Writer writer = Writer::kThis);

  // An own file of this name, if there is one, goes with commit; any other file stays.
  void drop(const std::filesystem::path& file, const FileMark& mark);

  // These do the same for `name` in `folder / subfolder`, which need not exist. There may be many such files:
  // each takes less than 400 bytes of memory once it is gone. The caller writes and closes it before commit.
  std::unique_ptr<OutputFile> open_in(const std::filesystem::path& folder, const std::string& subfolder,
                                      const std::string& name, const FileMark& mark);
  void drop_in(const std::filesystem::path& folder, const std::string& subfolder, const std::string& name,
               const FileMark& mark);

  // Replaces all files or none. Returns the names that have new files, in the order of add; a subfolder in
  // place of its files. Throws `Error`.
  std::vector<std::filesystem::path> commit();

 private:
  // These values identify a file and its content.
  struct FoundFile {
    dev_t device;
    ino_t number;
    off_t size;
    struct timespec written;
  };
  // The private folder next to names, and what it replaces or makes among them.
  struct Place {
    Place(const std::filesystem::path& folder, const std::string& subfolder, TemporaryFolder& staging);
    std::filesystem::path names, staged, older;
    std::string subfolder;  // empty without a subfolder
    TemporaryFolder* staging;
    bool has_new = false;  // files
    bool is_made = false;  // the subfolder, by commit
  };
  struct Member {
    std::string name;  // in its place
    Place* place = nullptr;
    std::optional<FoundFile> found;       // under the name, when it was checked
    std::unique_ptr<OutputFile> content;  // while it is open
    bool is_new = false;                  // else the older file goes, and nothing takes its place
    bool is_aside = false;                // the older file has moved there
    bool is_in_place = false;             // the new file has its name

    std::filesystem::path path() const { return place->names / name; }
    std::filesystem::path staged() const { return place->staged / name; }
    std::filesystem::path older() const { return place->older / name; }
  };

  static bool is_same_file(const FoundFile& a, const FoundFile& b);
  static std::optional<FoundFile> find_file(const std::filesystem::path& name);
  Place& place_of(const std::filesystem::path& folder, const std::string& subfolder);
  Member& join(Place& place, const std::string& name, const std::optional<FoundFile>& found);
  static void set_aside(Member& member);
  static void put_in_place(Member& member);
  void make_subfolders();
  void sync_folders() const;
  std::string put_back();

  Overwrite overwrite_;
  std::map<std::filesystem::path, TemporaryFolder> private_folders_;  // by the folder of names
  std::map<std::pair<std::filesystem::path, std::string>, Place> places_;
  std::list<Member> members_;  // in the order of add
};

}  // namespace lacuna::io
