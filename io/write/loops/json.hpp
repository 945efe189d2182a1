// SPDX-License-Identifier: Apache-2.0
// The parts that the results in JSON share.
#pragma once

#include "engine/model/detection.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/read/files/json_file.hpp"
#include "io/read/options/options.hpp"
#include "io/read/scan/row_filter.hpp"

#include <functional>
#include <string>
#include <string_view>

namespace lacuna::io {

class ScanFiles;

// The form of holes.json, which docs/holes.schema.json describes.
inline constexpr std::string_view kHolesSchema = "holes 3";

inline constexpr std::string_view kResultOfDetect = "a result of lacuna detect";  // for read_json()

// Returns the first keys of each file: the program's version and the form of the file, such as "holes 1".
Json begin_json(std::string_view schema);

// Prints with the indent of nlohmann::json: -1 gives one line. A path need not be UTF-8, but the text is.
std::string print(const Json& json, int indent);

Json list(const Eigen::Vector3d& vector);
Json corners(const Eigen::AlignedBox3d& box);  // {min, max}; null where it is empty
Json stations_json(const std::vector<StationSummary>& stations);
Json strays_json(const Strays& strays);
Json counts_of(const FilteredOut& filtered);  // by filter

// Adds the keys `crs`, null if there is none, and `unit`, empty if it is not known.
void put_crs(const ScanFiles& scan, Json& json);
// Returns the values of the sections that `is_wanted` names, by section and key.
Json parameter_values(FilesConfig config, const std::function<bool(std::string_view section)>& is_wanted);

}  // namespace lacuna::io
