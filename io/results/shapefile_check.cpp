// SPDX-License-Identifier: Apache-2.0
// ESRI Shapefile Technical Description, July 1998; dBASE:
// https://www.dbase.com/Knowledgebase/INT/db7_file_fmt.htm
#include "io/results/shapefile_check.hpp"

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <system_error>

namespace lacuna::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHead = 32;

std::optional<std::array<std::uint8_t, kHead>> read_head(const fs::path& file) {
  std::array<char, kHead> bytes{};
  std::array<std::uint8_t, kHead> head{};
  if (!std::ifstream(file, std::ios::binary).read(bytes.data(), kHead)) return std::nullopt;
  for (std::size_t i = 0; i < kHead; ++i) head[i] = static_cast<std::uint8_t>(bytes[i]);
  return head;
}

// Returns the size as the head says; nothing if there is no head.
std::optional<std::uint64_t> full_size(const fs::path& file, bool is_table) {
  const auto head = read_head(file);
  if (!head) return std::nullopt;
  const auto byte = [&](std::size_t i) { return std::uint64_t{(*head)[i]}; };
  if (is_table) {
    const std::uint64_t rows = byte(4) | byte(5) << 8 | byte(6) << 16 | byte(7) << 24;
    return (byte(8) | byte(9) << 8) + rows * (byte(10) | byte(11) << 8);
  }
  return 2 * (byte(24) << 24 | byte(25) << 16 | byte(26) << 8 | byte(27));
}

}  // namespace

fs::path find_cut_part(const fs::path& shp, bool with_crs) {
  std::error_code error;  // as if it were missing
  for (const char* extension : {".shp", ".shx", ".dbf", ".cpg", ".prj"}) {
    if (extension == std::string_view(".prj") && !with_crs) continue;
    const fs::path file = fs::path(shp).replace_extension(extension);
    const std::uint64_t size = fs::exists(file, error) ? fs::file_size(file, error) : 0;
    const bool has_head = extension[1] == 's' || extension[1] == 'd';
    const auto needed = has_head ? full_size(file, extension[1] == 'd') : std::optional<std::uint64_t>(1);
    if (error || !needed || size < *needed) return file;
  }
  return {};
}

}  // namespace lacuna::io
