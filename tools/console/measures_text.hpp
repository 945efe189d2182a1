// SPDX-License-Identifier: Apache-2.0
// Counts, lengths, areas, places and tables as a person reads them. `unit` is the unit of the scan's
// coordinates, such as "m"; empty if not known.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::tools {

std::string print_count(std::uint64_t count);  // "1,234,567"
// "1 void", "1,234 voids"
std::string counted(std::uint64_t count, std::string_view one, std::string_view several);

// Prints three digits, without an exponent from 0.001 to a million: "0.0123 m", "2.28 m", "1,234 m".
std::string print_length(double length, std::string_view unit);
std::string print_area(double area, std::string_view unit);  // "3.97 m²"
std::string print_share(double share);                       // "100 %" for 1

// Prints x y z, to a hundredth of the power of ten below `extent`, the size of the scan. So all places of one
// scan have equally many decimals.
std::string print_place(const Eigen::Vector3d& place, double extent);

// Prints rows of equally many cells; there is at least one row. Each column is as wide as its widest cell.
// The first column is aligned to the left, the others to the right.
std::string print_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace lacuna::tools
