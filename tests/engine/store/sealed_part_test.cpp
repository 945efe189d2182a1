// SPDX-License-Identifier: Apache-2.0
// Parts of a workspace: what is read of one is what was written, or there is no such part.
#include "engine/store/sealed_part.hpp"

#include "tests/support/test.hpp"

namespace lacuna {
namespace {

using Numbers = std::vector<std::uint64_t>;

constexpr std::string_view kMadeFrom = "this input";

Numbers counted(std::size_t count, std::uint64_t first) {
  Numbers numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

void add(PartWriter& part, const char* stream, std::uint64_t key, const Numbers& numbers) {
  part.add(stream, key, std::span<const std::uint64_t>(numbers));
}

// Two streams and three keys.
fs::path sealed(const ScratchFolder& folder, std::size_t count = 5) {
  PartWriter part(folder / "part");
  add(part, "a", 7, counted(count, 0));
  add(part, "b", 7, {});
  add(part, "a", 2, counted(count, 100));
  add(part, "b", 300, counted(3, 200));
  add(part, "a", 7, counted(2, 300));
  part.seal(kMadeFrom);
  return folder / "part";
}

TEST_CASE("a part gives back its entries by stream and key, in their order") {
  for (const std::size_t count : {0, 5, 400'000}) {  // the last is more than a block
    const ScratchFolder folder;
    const std::optional<PartReader> part = PartReader::open(sealed(folder, count), kMadeFrom);
    REQUIRE(part);
    CHECK(part->keys() == Numbers{2, 7, 300});
    CHECK(part->streams(7) == std::vector<std::string>{"a", "b"});
    Numbers both = counted(count, 0);
    both.push_back(300);
    both.push_back(301);
    CHECK(part->records<std::uint64_t>("a", 7) == both);
    CHECK(part->records<std::uint64_t>("a", 2) == counted(count, 100));
    CHECK(part->records<std::uint64_t>("b", 300) == counted(3, 200));
    CHECK(part->records<std::uint64_t>("b", 7).empty());
    CHECK(part->records<std::uint64_t>("c", 7).empty());
    CHECK(part->records<std::uint64_t>("a", 8).empty());
    CHECK(part->size("a", 7) == (count + 2) * sizeof(std::uint64_t));
    Numbers read(count + 2);
    part->read("a", 7, std::as_writable_bytes(std::span(read)));
    CHECK(read == both);
    CHECK(part->size("c", 7) == 0);
    CHECK(folder.names() == std::vector<std::string>{"part"});
  }
}

TEST_CASE("a stream of other records than are read is damaged") {
  const ScratchFolder folder;
  struct Three {
    std::uint64_t values[3];
  };
  const std::optional<PartReader> part = PartReader::open(sealed(folder), kMadeFrom);
  CHECK_THROWS_AS(part->records<Three>("a", 2), DamagedFile);
  CHECK_THROWS_AS(part->record<std::uint64_t>("missing"), DamagedFile);
}

TEST_CASE("a part that was not sealed leaves nothing, and is in nobody's way") {
  const ScratchFolder folder;
  {
    PartWriter part(folder / "part");
    add(part, "a", 1, counted(300'000, 0));
  }
  CHECK(folder.names().empty());
  CHECK_FALSE(PartReader::open(folder / "part", kMadeFrom));
  sealed(folder);
  CHECK(PartReader::open(folder / "part", kMadeFrom));
}

TEST_CASE("what is made from something else, or is no part, is none") {
  const ScratchFolder folder;
  const fs::path part = sealed(folder);
  CHECK_FALSE(PartReader::open(part, "another input"));
  CHECK(PartReader::is_part(part));
  fs::create_directory(folder / "folder");
  fs::create_symlink(part, folder / "link");
  folder.write("empty", "");
  folder.write("text", std::string(1000, 'x'));
  for (const char* name : {"folder", "link", "empty", "text", "missing"}) {
    INFO(name);
    CHECK_FALSE(PartReader::open(folder / name, kMadeFrom));
    CHECK_FALSE(PartReader::is_part(folder / name));
  }
}

TEST_CASE("a part that is cut at any length is none") {
  const ScratchFolder folder;
  const fs::path part = sealed(folder);
  const std::string whole = test::read_file(part);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    folder.write("part", std::string_view(whole).substr(0, length));
    if (PartReader::open(part, kMadeFrom)) FAIL_CHECK("cut to " << length << " bytes");
  }
  folder.write("part", whole + "x");
  CHECK_FALSE(PartReader::open(part, kMadeFrom));
}

TEST_CASE("a part with any bit flipped is none, or the entry with that bit cannot be read") {
  const ScratchFolder folder;
  const fs::path path = sealed(folder);
  const std::string whole = test::read_file(path);
  std::size_t damaged_entries = 0;
  for (std::size_t byte = 0; byte < whole.size(); ++byte) {
    std::string damaged = whole;
    damaged[byte] = static_cast<char>(damaged[byte] ^ (1 << (byte % 8)));
    folder.write("part", damaged);
    const std::optional<PartReader> part = PartReader::open(path, kMadeFrom);
    if (!part) continue;
    ++damaged_entries;
    std::size_t found = !part->made_from();
    for (const std::uint64_t key : part->keys()) {
      for (const std::string& stream : part->streams(key)) {
        try {
          part->records<std::uint64_t>(stream, key);
        } catch (const DamagedFile& error) {
          ++found;
          CHECK(error.file() == path);
        }
      }
    }
    INFO("byte " << byte);
    CHECK(found == 1);
  }
  CHECK(damaged_entries == 15 * sizeof(std::uint64_t) + kMadeFrom.size());
}

}  // namespace
}  // namespace lacuna
