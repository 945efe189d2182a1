#include "io/results/gis_library.hpp"

#include "engine/run/error.hpp"

#include <mutex>
#include <system_error>

#include <dlfcn.h>
#include <spdlog/spdlog.h>

namespace lacuna::io {
namespace {

namespace fs = std::filesystem;

fs::path find_library() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path installed = folder.parent_path() / "lib" / "lacuna";
  for (const fs::path& place : {folder, installed}) {
    if (fs::exists(place / "lacuna_gis.so", error)) return place / "lacuna_gis.so";
  }
  throw Error("lacuna_gis.so: is neither in " + folder.string() + " nor in " + installed.string() +
              "; --gpkg, --geojson and --shp need it");
}

// It stays loaded until the program ends.
WriteLoopsGis* load() {
  const fs::path file = find_library();
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw Error(file.string() + ": cannot be loaded: " + ::dlerror());
  void* const function = ::dlsym(library, kWriteLoopsGis);
  if (function == nullptr) throw Error(file.string() + ": is not of this version of lacuna");
  return reinterpret_cast<WriteLoopsGis*>(function);
}

}  // namespace

void check_gis_library() {
  find_library();
}

void write_loops_gis(const Detection& detection, const FileScan& scan, GisFormat format, OutputFile& out) {
  static WriteLoopsGis* const write = load();
  GisTask task{.detection = detection,
               .format = format,
               .crs = scan.common_crs(),
               .name = out.path(),
               .place = {},
               .take = {}};
  if (format == GisFormat::kGeoJson) {
    task.take = [&](std::string_view text) { out.write(text); };
  } else {
    task.place = out.place();
  }
  if (write(task)) return;
  static std::once_flag warned;
  std::call_once(warned, [&] {
    spdlog::warn(
        "{}: GDAL does not understand the coordinate reference system of the scan; the files for GIS have "
        "none",
        scan.files().front().string());
  });
}

}  // namespace lacuna::io
