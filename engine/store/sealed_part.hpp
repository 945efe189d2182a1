// SPDX-License-Identifier: Apache-2.0
// A sealed part: a kept file that outlives the process. It holds what a step of a run has found.
//
// A part consists of entries: records of one stream that belong to one key, such as a tile. The last entry is
// what the part was made from. The table of the entries follows, with the digest of each. The last bytes are
// the table's length, its checksum and the fingerprint of what the part was made from. So a part proves by
// itself from what it was made, and each entry proves that it is whole when it is read. The name of a file
// proves nothing. Its name is complete only once all of it is on the disk.
#pragma once

#include "engine/run/error.hpp"
#include "engine/store/digest.hpp"
#include "engine/store/store_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace lacuna {

// A kept file does not have the bytes that were sealed.
class DamagedFile : public Error {
 public:
  explicit DamagedFile(std::filesystem::path file);
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
};

// Writes entries in any order, from one thread at a time. Without `seal` no file remains.
class PartWriter {
 public:
  explicit PartWriter(std::filesystem::path path);  // the final one
  ~PartWriter();
  PartWriter(PartWriter&&) noexcept;

  // Adds an entry. Several entries of one stream and key are read as one, in their order. Streams: up to 23
  // characters.
  void add(std::string_view stream, std::uint64_t key, std::span<const std::byte> bytes);
  template <class Record>
  void add(std::string_view stream, std::uint64_t key, std::span<const Record> records) {
    static_assert(std::is_trivially_copyable_v<Record>);
    add(stream, key, std::as_bytes(records));
  }
  // Adds records of the key 0.
  template <class Record>
  void add(std::string_view stream, const std::vector<Record>& records) {
    add(stream, 0, std::span<const Record>(records));
  }
  template <class Record>
  void add_one(std::string_view stream, const Record& record) {
    add(stream, 0, std::span<const Record>(&record, 1));
  }
  std::uint64_t bytes() const;
  // Seals the part with what it was made from. Returns the checksum of the table.
  Digest seal(std::string_view made_from);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Adds the records that for_each(visit) visits. Some thousands are in memory at a time.
template <class Record, class ForEach>
void add_in_blocks(PartWriter& part, std::string_view stream, std::uint64_t key, ForEach&& for_each) {
  constexpr std::size_t kTogether = 1 << 14;
  std::vector<Record> block;
  const auto write = [&] {
    part.add(stream, key, std::span<const Record>(block));
    block.clear();
  };
  for_each([&](const Record& record) {
    block.push_back(record);
    if (block.size() == kTogether) write();
  });
  if (!block.empty()) write();
}

// Reads may come from several threads.
class PartReader {
 public:
  // Returns whether the file ends as parts do. It may be damaged elsewhere.
  static bool is_part(const std::filesystem::path& path);
  // Opens a part. Returns nothing if the part is missing, its table is not whole, or it was made from
  // something other than `made_from`. Without `made_from`, it may be made from anything.
  static std::optional<PartReader> open(const std::filesystem::path& path,
                                        std::optional<std::string_view> made_from);

  const Digest& checksum() const { return checksum_; }  // of the table, and so of all entries
  std::optional<std::string> made_from() const;         // nothing where it is damaged
  // Returns the text of a stream. Returns nothing where it is damaged.
  std::optional<std::string> text(std::string_view stream, std::uint64_t key = 0) const;

  std::vector<std::uint64_t> keys() const;  // ascending
  std::vector<std::string> streams(std::uint64_t key) const;
  std::uint64_t size(std::string_view stream, std::uint64_t key) const;  // bytes; 0 where there is no entry
  // Reads an entry. `to` has `size` bytes. Reading throws `DamagedFile` where the bytes have another
  // digest than the table says.
  void read(std::string_view stream, std::uint64_t key, std::span<std::byte> to) const;
  // Returns the records of an entry, and an empty vector where there is no entry. Throws `DamagedFile` where
  // the bytes are no whole number of records.
  template <class Record>
  std::vector<Record> records(std::string_view stream, std::uint64_t key = 0) const;
  // Returns the record of a stream that has one. Throws `DamagedFile` where it has none, or several.
  template <class Record>
  Record record(std::string_view stream) const {
    const std::vector<Record> all = records<Record>(stream);
    if (all.size() != 1) fail_damaged();
    return all.front();
  }
  // Calls visit(records) for one entry after the other.
  template <class Record, class Visit>
  void for_each(std::string_view stream, std::uint64_t key, Visit&& visit) const;

 private:
  struct Extent {
    std::uint64_t offset, bytes;
    Digest digest;
  };
  explicit PartReader(StoreFile file) : file_(std::move(file)) {}
  void read(const Extent& extent, std::span<std::byte> to) const;
  std::span<const Extent> extents(std::string_view stream, std::uint64_t key) const;
  [[noreturn]] void fail_damaged() const;

  StoreFile file_;
  Digest checksum_{};
  std::map<std::uint64_t, std::map<std::string, std::vector<Extent>, std::less<>>> entries_;  // by key
};

template <class Record, class Visit>
void PartReader::for_each(std::string_view stream, std::uint64_t key, Visit&& visit) const {
  static_assert(std::is_trivially_copyable_v<Record>);
  std::vector<Record> records;
  for (const Extent& extent : extents(stream, key)) {
    if (extent.bytes % sizeof(Record) != 0) fail_damaged();
    records.resize(extent.bytes / sizeof(Record));
    read(extent, std::as_writable_bytes(std::span(records)));
    visit(std::span<const Record>(records));
  }
}

template <class Record>
std::vector<Record> PartReader::records(std::string_view stream, std::uint64_t key) const {
  std::vector<Record> all;
  for_each<Record>(stream, key,
                   [&](std::span<const Record> some) { all.insert(all.end(), some.begin(), some.end()); });
  return all;
}

}  // namespace lacuna
