// SPDX-License-Identifier: Apache-2.0
#include "engine/run/regular_file.hpp"

#include "engine/run/error.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include <sys/stat.h>

namespace lacuna {

void check_regular_file(const std::filesystem::path& file, std::string_view needed) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    const std::string name = file.string();
    // A path made shorter has one slash of an address.
    for (const char* begin : {"http:/", "https:/", "ftp:/", "s3:/", "gs:/", "az:/"}) {
      if (name.find(begin) == 0)
        throw Error(name + ": is an address, which is not read; download it first, as with curl -O");
    }
    throw Error(name + ": cannot be opened: " + std::strerror(errno));
  }
  if (S_ISREG(status.st_mode)) return;
  const std::string what = S_ISDIR(status.st_mode) ? "is a folder" : "is not a regular file";
  throw Error(file.string() + ": " + what + "; " + std::string(needed) + " is needed");
}

}  // namespace lacuna
