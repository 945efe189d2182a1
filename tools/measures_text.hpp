// SPDX-License-Identifier: Apache-2.0
// Lengths, areas and places as a person reads them. `unit` is that of the scan's coordinates, such as "m";
// empty: not known.
#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>

namespace lacuna::tools {

// Three digits, without an exponent from 0.001 to a million: "0.0123 m", "2.28 m", "1,234 m".
std::string print_length(double length, std::string_view unit);
std::string print_area(double area, std::string_view unit);  // "3.97 m²"
std::string print_share(double share);                       // likewise, 1 as "100 %"

std::string print_power(double power_of_ten, std::string_view unit);  // "0.1 m", "1 m", "1,000 m"

// x y z, to a hundredth of the power of ten below `extent`, the size of the scan. So all places of one scan
// have equally many decimals.
std::string print_place(const Eigen::Vector3d& place, double extent);

}  // namespace lacuna::tools
