// SPDX-License-Identifier: Apache-2.0
#include "engine/store/sealed_part.hpp"

#include "engine/run/error.hpp"

#include <cassert>
#include <cstring>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlock = 1 << 20;  // bytes read or written together
constexpr std::array<char, 8> kMagic = {'l', 'a', 'c', 'u', 'n', 'a', '0', '3'};
constexpr std::string_view kMadeFrom = "made from";  // the stream, of a key that no other stream has
constexpr std::uint64_t kOfMadeFrom = UINT64_MAX;

struct Entry {
  std::array<char, 24> stream;
  std::uint64_t key, offset, bytes;
  Digest digest;
};

// The last bytes of a part.
struct Trailer {
  std::uint64_t entries;  // their table ends where the trailer begins
  Digest made_from;
  Digest checksum;  // of the table, and of the two fields before
  std::array<char, 8> magic;
};

Digest checksum_of(std::span<const Entry> table, const Trailer& trailer) {
  Hash hash;
  hash.add(std::as_bytes(table));
  hash.add(std::as_bytes(std::span(&trailer.entries, 1)));
  hash.add(std::as_bytes(std::span(trailer.made_from)));
  return hash.digest();
}

std::optional<Trailer> trailer_of(const StoreFile& file) {
  Trailer trailer;
  if (file.size() < sizeof trailer) return std::nullopt;
  file.read(file.size() - sizeof trailer, std::as_writable_bytes(std::span(&trailer, 1)));
  if (trailer.magic != kMagic) return std::nullopt;
  return trailer;
}

}  // namespace

DamagedFile::DamagedFile(fs::path file)
    : Error(file.string() + ": its bytes are not those that were sealed"), file_(std::move(file)) {}

struct PartWriter::State {
  explicit State(fs::path path)
      : path(std::move(path)),
        file(this->path.string() + "." + random_digits() + kUnsealed, StoreFile::Name::kKept) {}

  void write(std::span<const std::byte> bytes) {
    if (block.size() + bytes.size() > kBlock) flush();
    if (bytes.size() < kBlock) {
      block.insert(block.end(), bytes.begin(), bytes.end());
    } else {
      file.append(bytes);
    }
    size += bytes.size();
  }
  void flush() {
    file.append(block);
    file.start_sync();
    block.clear();
  }

  fs::path path;
  StoreFile file;
  std::vector<std::byte> block;
  std::uint64_t size = 0;
  std::vector<Entry> table;
};

PartWriter::PartWriter(fs::path path) : state_(std::make_unique<State>(std::move(path))) {}
PartWriter::PartWriter(PartWriter&&) noexcept = default;
PartWriter::~PartWriter() = default;

void PartWriter::add(std::string_view stream, std::uint64_t key, std::span<const std::byte> bytes) {
  Entry entry{{}, key, state_->size, bytes.size(), digest_of(bytes)};
  assert(stream.size() < entry.stream.size());
  stream.copy(entry.stream.data(), entry.stream.size() - 1);
  state_->table.push_back(entry);
  state_->write(bytes);
}

std::uint64_t PartWriter::bytes() const {
  return state_->size;
}

Digest PartWriter::seal(std::string_view made_from) {
  add(kMadeFrom, kOfMadeFrom, std::span<const char>(made_from));
  State& s = *state_;
  s.write(std::as_bytes(std::span(s.table)));
  s.flush();
  Trailer trailer{
      .entries = s.table.size(), .made_from = digest_of(made_from), .checksum = {}, .magic = kMagic};
  trailer.checksum = checksum_of(s.table, trailer);
  s.file.append(std::as_bytes(std::span(&trailer, 1)));
  s.file.seal(s.path);
  return trailer.checksum;
}

bool PartReader::is_part(const fs::path& path) {
  const std::optional<StoreFile> file = StoreFile::open_sealed(path);
  return file && trailer_of(*file);
}

std::optional<PartReader> PartReader::open(const fs::path& path, std::optional<std::string_view> made_from) {
  std::optional<StoreFile> file = StoreFile::open_sealed(path);
  if (!file) return std::nullopt;
  const std::optional<Trailer> trailer = trailer_of(*file);
  if (!trailer || (made_from && trailer->made_from != digest_of(*made_from))) return std::nullopt;
  const std::uint64_t end = file->size() - sizeof *trailer;
  if (trailer->entries > end / sizeof(Entry)) return std::nullopt;
  std::vector<Entry> table(trailer->entries);
  const std::uint64_t begin = end - table.size() * sizeof(Entry);
  file->read(begin, std::as_writable_bytes(std::span(table)));
  if (checksum_of(table, *trailer) != trailer->checksum) return std::nullopt;
  PartReader part(*std::move(file));
  part.checksum_ = trailer->checksum;
  std::uint64_t bytes = 0;
  for (const Entry& entry : table) {
    part.entries_[entry.key][entry.stream.data()].push_back({entry.offset, entry.bytes, entry.digest});
    bytes += entry.bytes;
  }
  if (bytes != begin) return std::nullopt;  // it was cut in its middle
  return part;
}

std::vector<std::uint64_t> PartReader::keys() const {
  std::vector<std::uint64_t> keys;
  for (const auto& [key, streams] : entries_) {
    if (key != kOfMadeFrom) keys.push_back(key);
  }
  return keys;
}

std::optional<std::string> PartReader::made_from() const {
  return text(kMadeFrom, kOfMadeFrom);
}

std::optional<std::string> PartReader::text(std::string_view stream, std::uint64_t key) const {
  try {
    const std::vector<char> text = records<char>(stream, key);
    return std::string(text.begin(), text.end());
  } catch (const DamagedFile&) {
    return std::nullopt;
  }
}

std::vector<std::string> PartReader::streams(std::uint64_t key) const {
  std::vector<std::string> names;
  const auto at = entries_.find(key);
  if (at == entries_.end()) return names;
  for (const auto& [name, extents] : at->second) names.push_back(name);
  return names;
}

std::uint64_t PartReader::size(std::string_view stream, std::uint64_t key) const {
  std::uint64_t bytes = 0;
  for (const Extent& extent : extents(stream, key)) bytes += extent.bytes;
  return bytes;
}

void PartReader::read(std::string_view stream, std::uint64_t key, std::span<std::byte> to) const {
  for (const Extent& extent : extents(stream, key)) {
    read(extent, to.first(extent.bytes));
    to = to.subspan(extent.bytes);
  }
}

void PartReader::read(const Extent& extent, std::span<std::byte> to) const {
  file_.read(extent.offset, to);
  if (digest_of(std::span<const std::byte>(to)) != extent.digest) fail_damaged();
}

std::span<const PartReader::Extent> PartReader::extents(std::string_view stream, std::uint64_t key) const {
  const auto at_key = entries_.find(key);
  if (at_key == entries_.end()) return {};
  const auto at = at_key->second.find(stream);
  if (at == at_key->second.end()) return {};
  return at->second;
}

void PartReader::fail_damaged() const {
  throw DamagedFile(file_.path());
}

}  // namespace lacuna
