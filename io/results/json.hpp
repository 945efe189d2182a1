// What the results in JSON share.
#pragma once

#include "engine/config.hpp"
#include "engine/model/points.hpp"
#include "io/row_filter.hpp"

#include <functional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace lacuna::io {

using Json = nlohmann::ordered_json;  // keys stay in the order given; what is not finite is printed as null

// The first keys of each file: the program's version and the form of the file, such as "holes 1".
Json begin_json(std::string_view schema);

// With the indent of nlohmann::json: -1 for one line. A path need not be UTF-8, the text is.
std::string print(const Json& json, int indent);

Json list(const Eigen::Vector3d& vector);
Json counts_of(const FilteredOut& filtered);  // by filter

// Of the sections that `is_wanted` names, by section and key.
Json parameter_values(Config config, const std::function<bool(std::string_view section)>& is_wanted);

}  // namespace lacuna::io
