// SPDX-License-Identifier: Apache-2.0
#include "io/results/local_coordinates.hpp"
#include "io/results/points_pcd_rows.hpp"
#include "io/scalar.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

// The columns of any formats, in PCL's conventions.
struct Converted {
  RowLayout layout;  // of the joined rows, colours side by side where they become one field
  std::vector<PcdField> fields;
  std::optional<std::size_t>
      colour;  // offset of red in the layout; then green, blue and, if there is one, alpha
  std::size_t channels = 3;
};

Converted converted_fields(const FileScan& scan, const OutputConfig& config,
                           std::span<const ResultColumn> results) {
  const RowLayout joined = join_layouts(
      written_layouts(scan, config),
      [&](const RowLayout& layout, std::size_t i) { return is_earlier_result(layout, i, results); });
  constexpr std::array kChannels = {"red", "green", "blue", "alpha"};
  const auto is_byte = [&](const char* name) {
    const Property* const found = joined.find(name);
    return found != nullptr && found->type == Scalar::kUint8;
  };
  const bool is_packed = std::all_of(kChannels.begin(), kChannels.begin() + 3, is_byte);
  Converted made;
  made.channels = is_packed && is_byte("alpha") ? 4 : 3;
  const auto is_channel = [&](const std::string& name) {
    return is_packed &&
           std::find(kChannels.begin(), kChannels.begin() + static_cast<std::ptrdiff_t>(made.channels),
                     name) != kChannels.begin() + static_cast<std::ptrdiff_t>(made.channels);
  };

  std::set<std::string> names;
  for (const ResultColumn& result : results) names.insert(pcd_name_of(result.name));
  if (is_packed) names.insert({"rgb", "rgba"});
  // Names with a meaning in PCD, and second ones, get a number: a column `rgb` of four bytes would be a
  // colour.
  const auto unique_name = [&](const Property& property) {
    const std::string given = pcd_name_of(property.name);
    const bool is_colour = (given == "rgb" || given == "rgba") && size_of(property.type) == 4;
    std::string name = given;
    for (int i = 2; name == "_" || (is_colour && name == given) || names.contains(name); ++i)
      name = given + '_' + std::to_string(i);
    names.insert(name);
    return name;
  };
  std::vector<std::pair<std::string, Scalar>> columns;
  std::size_t offset = 0;
  for (const Property& property : joined.properties) {
    if (is_channel(property.name)) {
      if (made.colour) continue;
      made.colour = offset;
      for (std::size_t i = 0; i < made.channels; ++i) columns.emplace_back(kChannels[i], Scalar::kUint8);
      offset += made.channels;
      // PCL's own type of each.
      made.fields.push_back(
          {.name = made.channels == 4 ? "rgba" : "rgb", .type = made.channels == 4 ? 'U' : 'F'});
    } else {
      columns.emplace_back(property.name, property.type);
      offset += size_of(property.type);
      made.fields.push_back(pcd_field_of(unique_name(property), property.type));
    }
  }
  made.layout = packed_layout(columns);
  return made;
}

// Joined rows with the bytes of colours as one value of four bytes, blue lowest.
class PackedRows final : public InputRows {
 public:
  PackedRows(const FileScan& scan, Converted made, const LocalOffset& offset)
      : rows_(joined_rows(scan, made.layout, offset)), made_(std::move(made)) {}

  std::size_t next(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) override {
    const std::size_t count = rows_->next(max_rows, stride, block);
    if (!made_.colour) return count;
    const std::size_t end = *made_.colour + made_.channels;
    for (std::size_t row = 0; row < count; ++row) {
      std::byte* const colour = &block[row * stride + *made_.colour];
      if (made_.channels == 3) {
        std::memmove(colour + 4, colour + 3, made_.layout.stride - end);
        colour[3] = std::byte{0};
      }
      std::swap(colour[0], colour[2]);
    }
    return count;
  }

  void positions(std::vector<Eigen::Vector3d>& positions) const override { rows_->positions(positions); }

 private:
  std::unique_ptr<InputRows> rows_;
  Converted made_;
};

}  // namespace

PcdField pcd_field_of(std::string name, Scalar type) {
  const bool is_signed = type == Scalar::kInt8 || type == Scalar::kInt16 || type == Scalar::kInt32;
  return {.name = std::move(name),
          .type = is_integer(type) ? (is_signed ? 'I' : 'U') : 'F',
          .size = size_of(type)};
}

std::string pcd_name_of(const std::string& name) {
  if (name == "nx" || name == "ny" || name == "nz") return std::string("normal_") + name[1];
  return name;
}

PcdInput converted_pcd_input(const FileScan& scan, const OutputConfig& config,
                             std::span<const ResultColumn> results, const LocalOffset& offset) {
  Converted made = converted_fields(scan, config, results);
  PcdInput input;
  input.header.fields = made.fields;
  input.header.offset = offset;
  input.rows = std::make_unique<PackedRows>(scan, std::move(made), offset);
  return input;
}

}  // namespace lacuna::io
