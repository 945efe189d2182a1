// SPDX-License-Identifier: Apache-2.0
#include "io/stations/place_list.hpp"

#include "io/stations/list_lines.hpp"

namespace lacuna::io {

std::vector<ListedPosition> read_places(const std::filesystem::path& list) {
  ListLines lines(list, "x y z are needed, or a name and x y z");
  std::vector<ListedPosition> places;
  while (const auto fields = lines.next()) {
    if (fields->size() != 3 && fields->size() != 4) lines.fail();
    places.push_back({.name = fields->size() == 4 ? std::string(fields->front()) : "",
                      .position = lines.parse_place(fields->last(3))});
  }
  if (places.empty()) lines.fail_empty("names no place");
  return places;
}

}  // namespace lacuna::io
