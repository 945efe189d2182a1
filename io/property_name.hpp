// The names of properties, the same whatever the format they come from.
#pragma once

#include <string>
#include <string_view>

namespace lacuna {

// A name that can stand in a PLY header: blanks and control characters become '_', and X Y Z, NX NY NZ (in
// any mix of cases) the names of position and normal.
std::string property_name(std::string_view given);

}  // namespace lacuna
