// Result files that appear under their final name only when complete. Until then each is `<name>.partial`,
// which one run at a time writes, and is removed when the job fails.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna {

// What a file is called until it is complete.
std::filesystem::path partial_path(std::filesystem::path file);

class OutputFile {
 public:
  // Creates the partial file, over one that a killed run has left. Throws `Error`, also where another run is
  // writing it.
  explicit OutputFile(std::filesystem::path file);
  ~OutputFile();  // removes the partial file unless it was committed
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& path() const { return file_; }

  // Buffered. Throws `Error`: a full disk is noticed here or in close, never later.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  // Puts `text` over the first bytes of the file, which are written already: a count known at the end.
  void overwrite_start(std::string_view text);

  void close();   // nothing can be written after it
  void commit();  // closes, and gives the file its final name

 private:
  void open_alone();
  void flush();
  void put(std::uint64_t at, std::span<const std::byte> bytes);
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path file_;
  std::filesystem::path partial_;
  int descriptor_ = -1;
  int lock_ = -1;  // the same open file, locked until it has its final name
  bool committed_ = false;
  std::uint64_t end_ = 0;  // of what is in the file; the buffer follows
  std::vector<std::byte> buffer_;
};

// The results of one run: none of them is in place before all are complete.
class OutputSet {
 public:
  explicit OutputSet(std::filesystem::path folder) : folder_(std::move(folder)) {}

  OutputFile& add(const std::string& name);

  // Removes what an earlier run has left under the names of this set and of `stale`, then puts the files in
  // place in the order in which they were added. Results of two runs never stand side by side, and the last
  // file says that all the others are there.
  void commit(const std::vector<std::string>& stale);

 private:
  std::filesystem::path folder_;
  std::vector<std::unique_ptr<OutputFile>> files_;
};

}  // namespace lacuna
