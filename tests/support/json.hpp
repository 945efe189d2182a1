// SPDX-License-Identifier: Apache-2.0
// JSON for tests. Its parser and its text are compiled once, and not in each test.
#pragma once

#include "tests/support/test.hpp"

#include <nlohmann/json.hpp>

template <>
struct Catch::StringMaker<nlohmann::json> {
  static std::string convert(const nlohmann::json& value);
};

namespace lacuna::test {

nlohmann::json json_of(const std::string& text);
// The content of a result in JSON.
nlohmann::json read_json(const fs::path& file);

}  // namespace lacuna::test
