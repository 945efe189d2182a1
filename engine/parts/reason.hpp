// SPDX-License-Identifier: Apache-2.0
// Why a part is made: what differs from the part that is there.
#pragma once

#include "engine/store/digest.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna {

// Why a part is made.
struct Reason {
  enum class Why : std::uint8_t {
    kNew,        // it was not there
    kUnusable,   // it is there, without its columns, or with tiles that do not fit in memory
    kDamaged,    // its bytes are not those that were sealed
    kInput,      // a file of the input has changed
    kParameter,  // a parameter has changed
    kFollows,    // a step before it has changed
  };
  Why why = Why::kNew;
  std::string was, is;  // the first line that has changed

  std::string words() const;  // "damaged", "\"k = 15\" is \"k = 20\" now"
};

// Returns why a part is made that a file should have, from `made_from`.
Reason reason_of(const std::filesystem::path& file, const std::string& made_from);

// Returns a checksum as a line.
std::string line_of(const Digest& checksum);

// Returns the parts of a text, each of which ends with `end`.
std::vector<std::string> split(std::string_view text, char end);
// Returns the first line of each text that the other one does not have.
std::pair<std::string, std::string> first_difference(const std::string& was, const std::string& is);

}  // namespace lacuna
