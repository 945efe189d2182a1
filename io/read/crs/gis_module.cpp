// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/gis_module.hpp"

#include "engine/run/error.hpp"

#include <filesystem>
#include <string>
#include <system_error>

#include <dlfcn.h>

namespace lacuna::io {
namespace {

namespace fs = std::filesystem;

// Returns the folder of the program, or of the library that holds this code, such as a module of Python.
fs::path own_folder() {
  Dl_info self{};
  const bool is_known = ::dladdr(reinterpret_cast<const void*>(&own_folder), &self) != 0;
  const fs::path file = is_known ? self.dli_fname : "";
  std::error_code error;
  // A program's name may be anything; a library's name may end with its version.
  const bool is_library = file.is_absolute() && file.filename().string().find(".so") != std::string::npos;
  return (is_library ? file : fs::read_symlink("/proc/self/exe", error)).parent_path();
}

fs::path find_module(const char* user) {
  std::error_code error;
  const fs::path folder = own_folder();
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path installed = program.parent_path() / "lib" / "lacuna";
  // The shared library lies in lib, or in lib/x86_64-linux-gnu.
  for (const fs::path& place : {folder, installed, folder / "lacuna", folder.parent_path() / "lacuna"}) {
    if (fs::exists(place / "lacuna_gis.so", error)) return place / "lacuna_gis.so";
  }
  throw Error("lacuna_gis.so: is neither in " + folder.string() + " nor in " + installed.string() + "; " +
              user + " need it");
}

}  // namespace

void check_gis_module(const char* user) {
  find_module(user);
}

void* load_gis_function(const char* name, const char* user) {
  const fs::path file = find_module(user);
  void* const module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) throw Error(file.string() + ": cannot be loaded: " + ::dlerror());
  void* const function = ::dlsym(module, name);
  if (function == nullptr) throw Error(file.string() + ": is not of this version of lacuna");
  return function;
}

void* find_gis_function(const char* name) {
  try {
    return load_gis_function(name, "");
  } catch (const Error&) {
    return nullptr;
  }
}

}  // namespace lacuna::io
