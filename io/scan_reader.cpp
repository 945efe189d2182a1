#include "io/scan_reader.hpp"

#include "io/input_file.hpp"
#include "io/obj_reader.hpp"
#include "io/off_reader.hpp"
#include "io/pcd_reader.hpp"
#include "io/ply_reader.hpp"
#include "io/stl_reader.hpp"
#include "io/text_reader.hpp"

#include <array>

namespace lacuna {
namespace {

struct Format {
  const char* name;
  bool (*recognises)(const FileStart& start);
  std::unique_ptr<ScanReader> (*open)(const std::filesystem::path& file, const ReadOptions& options);
};

// Tried in this order.
constexpr std::array kFormats = {
    Format{"PLY", looks_like_ply, open_ply},
    Format{"PCD", looks_like_pcd, open_pcd},
    Format{"OBJ", looks_like_obj, open_obj},
    Format{"OFF", looks_like_off, open_off},
    Format{"STL", looks_like_stl, open_stl},
    Format{"text (xyz, csv, pts)", looks_like_text, open_text},
};

constexpr std::size_t kFirstBytes = 4096;

std::string format_names() {
  std::string names;
  for (const Format& format : kFormats) names += (names.empty() ? "" : ", ") + std::string(format.name);
  return names;
}

}  // namespace

std::unique_ptr<ScanReader> open_scan(const std::filesystem::path& file, const ReadOptions& options) {
  InputFile in(file);
  const FileStart start{.first_bytes = in.peek(kFirstBytes), .size = in.position() + in.remaining()};
  if (start.first_bytes.empty()) in.fail_at_byte(0, "the file is empty; a scan file is needed");
  for (const Format& format : kFormats) {
    if (format.recognises(start)) return format.open(file, options);
  }
  in.fail_at_byte(0, "unknown format; allowed are " + format_names());
}

}  // namespace lacuna
