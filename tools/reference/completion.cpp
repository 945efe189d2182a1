// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/completion.hpp"

namespace lacuna::tools {

ValueKind kind_of(const OptionEntry& option) {
  if (!option.choices.empty()) return ValueKind::kChoice;
  if (option.value == "FILE" || option.value == "PATH") return ValueKind::kFile;
  if (option.value == "DIR") return ValueKind::kFolder;
  if (option.value == "SCAN") return ValueKind::kScan;
  if (option.value == "CONFIG") return ValueKind::kConfig;
  return ValueKind::kFree;
}

std::string join(const std::vector<std::string>& words, std::string_view between) {
  std::string joined;
  for (const std::string& word : words) joined += (joined.empty() ? "" : std::string(between)) + word;
  return joined;
}

std::string scan_endings(std::string_view between) {
  return join({kScanEndings.begin(), kScanEndings.end()}, between);
}

}  // namespace lacuna::tools
