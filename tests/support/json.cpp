// SPDX-License-Identifier: Apache-2.0
#include "tests/support/json.hpp"

std::string Catch::StringMaker<nlohmann::json>::convert(const nlohmann::json& value) {
  return value.dump();
}

namespace lacuna::test {

nlohmann::json json_of(const std::string& text) {
  return nlohmann::json::parse(text);
}

nlohmann::json read_json(const fs::path& file) {
  return json_of(read_file(file));
}

}  // namespace lacuna::test
