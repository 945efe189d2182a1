// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_records.hpp"

#include "io/read/files/input_file.hpp"
#include "io/read/las/las_bytes.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace lacuna::io {
std::string las_record_head(std::string_view user, std::uint16_t number, std::uint16_t bytes,
                            std::string_view description) {
  std::string head(kLasRecordHead, '\0');
  put_text(head, 2, 16, user);
  put_at(head, 18, number);
  put_at(head, 20, bytes);
  put_text(head, 22, 32, description);
  return head;
}

std::uint64_t copy_las_record(const std::filesystem::path& file, const LasRecordExtent& record,
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

}  // namespace lacuna::io
