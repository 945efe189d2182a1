#include "engine/core/index_file.hpp"

#include "engine/core/error.hpp"

#include <string>

#include <dlfcn.h>

namespace lacuna {
namespace {

constexpr char kModule[] = "lacuna_vdb.so";

// Loaded where it is needed only: see core/leaf_table. Never unloaded.
WriteIndex* load_writer() {
  void* const module = dlopen(kModule, RTLD_NOW | RTLD_LOCAL);
  void* const writer = module == nullptr ? nullptr : dlsym(module, "lacuna_write_index");
  if (writer == nullptr)
    throw Error(std::string(kModule) + ", which writes index.vdb, cannot be loaded: " + dlerror() +
                "; it belongs beside the program");
  return reinterpret_cast<WriteIndex*>(writer);
}

}  // namespace

void save_index(const CellGrid& grid, std::span<const IndexedCell> cells, const std::filesystem::path& file) {
  const std::string problem = load_writer()(grid.edge(), cells, file);
  if (!problem.empty()) throw Error(file.string() + ": cannot write: " + problem);
}

}  // namespace lacuna
