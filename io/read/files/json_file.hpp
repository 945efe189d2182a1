// SPDX-License-Identifier: Apache-2.0
// Reads JSON with a bound on everything that a file could let grow.
#pragma once

#include <filesystem>
#include <string_view>

#include <nlohmann/json.hpp>

namespace lacuna::io {

using Json = nlohmann::ordered_json;  // keys stay in the order given; what is not finite is printed as null

// Returns the content of a file. `keep` is called as nlohmann::json::parse does it, also for the values
// within what it leaves out. These take no memory, so a file of any size may be read. Throws `Error` if the
// file is not regular or not JSON. Throws, too, beyond 32 levels, 1 MiB for a value, or 4 million values that
// are kept. `needed` is for the error: "a result of lacuna detect".
Json read_json(const std::filesystem::path& file, std::string_view needed,
               const Json::parser_callback_t& keep = {});

}  // namespace lacuna::io
