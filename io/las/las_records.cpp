// SPDX-License-Identifier: Apache-2.0
#include "io/las/las_records.hpp"

#include "io/input_file.hpp"
#include "io/las/las_bytes.hpp"

#include <algorithm>
#include <charconv>
#include <span>
#include <vector>

namespace lacuna::io {
namespace {

constexpr std::size_t kExtendedHead = 60;

}  // namespace

std::string las_record_head(bool is_extended, std::string_view user, std::uint16_t number,
                            std::uint64_t bytes, std::string_view description) {
  std::string head(is_extended ? kExtendedHead : kLasRecordHead, '\0');
  put_text(head, 2, 16, user);
  put_at(head, 18, number);
  if (is_extended) {
    put_at(head, 20, bytes);
  } else {
    put_at(head, 20, static_cast<std::uint16_t>(bytes));
  }
  put_text(head, is_extended ? 28 : 22, 32, description);
  return head;
}

std::uint64_t copy_las_record(const std::filesystem::path& file, const LasRecordPlace& record,
                              OutputFile& out) {
  constexpr std::size_t kBuffer = std::size_t{1} << 16;
  InputFile in(file, kBuffer);
  in.skip(std::min(record.at, in.remaining()));
  std::vector<std::byte> bytes(kBuffer);
  for (std::uint64_t left = record.bytes; left > 0;) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left, kBuffer));
    in.read(bytes.data(), count);
    out.write(std::span(bytes).first(count));
    left -= count;
  }
  return record.bytes;
}

std::string geo_keys(std::string_view crs) {
  crs.remove_prefix(std::min<std::size_t>(5, crs.size()));
  std::uint16_t horizontal = 0, vertical = 0;
  const char* const end = crs.data() + crs.size();
  const auto [stop, status] = std::from_chars(crs.data(), end, horizontal);
  if (status != std::errc{}) return {};
  if (stop != end && *stop == '+') std::from_chars(stop + 1, end, vertical);
  const bool is_geographic = horizontal >= 4000 && horizontal < 5000;
  struct Key {
    std::uint16_t key, place, count, value;
  };
  std::vector<Key> keys = {{1024, 0, 1, static_cast<std::uint16_t>(is_geographic ? 2 : 1)},
                           {static_cast<std::uint16_t>(is_geographic ? 2048 : 3072), 0, 1, horizontal}};
  if (vertical != 0) keys.push_back({4096, 0, 1, vertical});
  std::string data;
  const auto add = [&](std::uint16_t value) {
    data.resize(data.size() + sizeof value);
    put_at(data, data.size() - sizeof value, value);
  };
  for (const std::uint16_t value : {1, 1, 0, static_cast<int>(keys.size())}) add(value);
  for (const Key& key : keys) {
    for (const std::uint16_t value : {key.key, key.place, key.count, key.value}) add(value);
  }
  return data;
}

}  // namespace lacuna::io
