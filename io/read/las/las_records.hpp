// SPDX-License-Identifier: Apache-2.0
// Variable length records as bytes, of either kind: those before the points and the extended ones behind
// them. Source: ASPRS LAS specification 1.4 R15, sections 2.5 to 2.7.
#pragma once

#include "io/read/files/output_file.hpp"
#include "io/read/las/las_header.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace lacuna::io {

// The user of records that the specification defines.
inline constexpr std::string_view kLasSpecification = "LASF_Spec";
inline constexpr std::uint16_t kLasExtraBytes = 4;
// The user of the record in which LASzip describes how points are compressed.
inline constexpr std::string_view kLaszip = "laszip encoded";
inline constexpr std::uint16_t kLaszipLayout = 22204;
inline constexpr std::size_t kLasRecordHead = 54;  // bytes, of records that are not extended

// The bytes before the data of a record that is not extended.
std::string las_record_head(std::string_view user, std::uint16_t number, std::uint16_t bytes,
                            std::string_view description);

// Copies a record of the file byte for byte. Returns the number of bytes copied. Throws `Error`.
std::uint64_t copy_las_record(const std::filesystem::path& file, const LasRecordExtent& record,
                              OutputFile& out);

}  // namespace lacuna::io
