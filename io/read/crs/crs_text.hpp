// SPDX-License-Identifier: Apache-2.0
// Facts about a coordinate reference system from its well-known text (OGC 01-009; ISO 19162).
#pragma once

#include <string>
#include <string_view>

namespace lacuna::io {

// Returns the part that positions are in, such as `PROJCS[...]` of a compound system. Returns an empty text
// if the text is a code, or has no such part.
std::string_view horizontal_system(std::string_view crs);

// Returns the part that heights are in, `VERT_CS[...]` of a compound system; empty if there is none.
std::string_view vertical_system(std::string_view crs);

// Whether the text is "EPSG:25832", "ESRI:102100", or a horizontal and a vertical one, "EPSG:25832+7837".
bool is_code(std::string_view text);

// Returns the name within well-known text, such as "NAD83 / UTM zone 10N"; a code stays as it is.
std::string name_of_crs(const std::string& crs);

// Whether the system is a zone of UTM, by its code or its name.
bool is_utm(std::string_view crs);

// Returns the horizontal part of a code or of well-known text.
std::string_view without_vertical(std::string_view crs);

// Whether positions are longitude and latitude. False where the text is a code.
bool is_geographic(std::string_view crs);

// Whether positions are from the centre of the Earth. False where the text is a code.
bool is_geocentric(std::string_view crs);

// Returns the code "EPSG:N" that a system in well-known text has of its own; empty if it has none.
std::string own_code(std::string_view system);

// Returns the last unit of length, as `UNIT["metre", 1]`. Units of angles, and of the geographic system below
// a projected one, come before it. Returns an empty text if there is none.
std::string_view unit_node(std::string_view system);

}  // namespace lacuna::io
