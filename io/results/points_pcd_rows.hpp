// SPDX-License-Identifier: Apache-2.0
// The rows of points.pcd, without the results: those of PCD files as they are, or the columns of any formats.
#pragma once

#include "io/file_scan.hpp"
#include "io/local_offset.hpp"
#include "io/options/options.hpp"
#include "io/pcd/pcd_header.hpp"
#include "io/results/annotated_rows.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>

namespace lacuna::io {

struct PcdInput {
  PcdHeader header;  // its fields are those of the rows; the image and the viewpoint of a file that has these
  std::unique_ptr<InputRows> rows;  // of the scan, which must live as long
};

// Without the fields that the results replace. None unless all files are PCD with the same fields and stay
// where they are. With an offset, x y z are floats relative to it, here and below. Else, where a file has
// local coordinates, they are doubles. Throws `Error`.
std::optional<PcdInput> kept_pcd_input(const FileScan& scan, std::span<const ResultColumn> results,
                                       const LocalOffset& offset);

// In PCL's conventions: colours of bytes are one field.
PcdInput converted_pcd_input(const FileScan& scan, const OutputConfig& config,
                             std::span<const ResultColumn> results, const LocalOffset& offset);

// A column as a field, and PCL's name of it: normals have other ones.
PcdField pcd_field_of(std::string name, Scalar type);
std::string pcd_name_of(const std::string& name);

}  // namespace lacuna::io
