// SPDX-License-Identifier: Apache-2.0
// Variable length records as bytes, of either kind: those before the points and the extended ones behind
// them. Source: ASPRS LAS specification 1.4 R15, sections 2.5 to 2.7.
#pragma once

#include "io/las/las_header.hpp"
#include "io/results/output_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace lacuna::io {

// "LASF_Projection" and "LASF_Spec" are the users of the records that the specification defines.
inline constexpr std::string_view kLasProjection = "LASF_Projection", kLasSpecification = "LASF_Spec";
inline constexpr std::uint16_t kLasExtraBytes = 4, kLasWellKnownText = 2112, kLasGeoKeys = 34735;
// That of LASzip says how points are compressed.
inline constexpr std::string_view kLaszip = "laszip encoded";
inline constexpr std::uint16_t kLaszipLayout = 22204;
inline constexpr std::size_t kLasRecordHead = 54, kMostLasRecordData = 65535;  // not extended ones

// What stands before the data of a record.
std::string las_record_head(bool is_extended, std::string_view user, std::uint16_t number,
                            std::uint64_t bytes, std::string_view description);

// Copies a record of the file byte for byte. Returns the number of these. Throws `Error`.
std::uint64_t copy_las_record(const std::filesystem::path& file, const LasRecordPlace& record,
                              OutputFile& out);

// "EPSG:N" or "EPSG:N+M" as a directory of GeoTIFF keys (GeoTIFF 1.1, 7.1); empty: no such code.
std::string geo_keys(std::string_view crs);

}  // namespace lacuna::io
