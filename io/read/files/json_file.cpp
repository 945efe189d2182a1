// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/json_file.hpp"

#include "engine/run/error.hpp"
#include "engine/run/machine.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

namespace lacuna::io {

Json read_json(const std::filesystem::path& file, std::string_view needed,
               const Json::parser_callback_t& keep) {
  check_regular_file(file, needed);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file.string() + ": cannot be opened: " + std::strerror(errno));
  const auto fail = [&](const std::string& reason) {
    throw Error(file.string() + ": " + reason + "; " + std::string(needed) + " is needed");
  };
  const auto take = [&](int depth, Json::parse_event_t event, Json& parsed) {
    constexpr int kDeepest = 32;  // printing and copying nested values is recursive
    if (depth > kDeepest) fail("is nested deeper than " + std::to_string(kDeepest) + " levels");
    return !keep || keep(depth, event, parsed);
  };
  try {
    return Json::parse(in, take);
  } catch (const Json::parse_error& error) {
    fail("byte " + std::to_string(error.byte) + ": is not JSON");
  } catch (const Json::out_of_range& error) {
    constexpr int kTooLarge = 406;
    if (error.id != kTooLarge) throw;  // of the caller
    fail("has a number beyond double precision");
  }
  return {};
}

}  // namespace lacuna::io
