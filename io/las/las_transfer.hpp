// SPDX-License-Identifier: Apache-2.0
// Points of one LAS file in the form that the files of a scan share.
#pragma once

#include "io/las/las_join.hpp"
#include "io/las/las_scale.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lacuna::io {

// What the form has besides, a point gets as io/las/las_join.hpp says.
class LasTransfer {
 public:
  // `name`: of the file. Its points are moved by the pose first, their normals turned.
  LasTransfer(std::string name, const LasHeader& from, const LasForm& to,
              std::optional<Eigen::Affine3d> pose);

  // `records` are raw ones of the file, one after the other. `out` is the first of as many in the form, each
  // `stride` bytes behind the one before. Throws `Error` where a coordinate does not fit, though the file's
  // header says so.
  void convert(std::span<const std::byte> records, std::size_t stride, std::byte* out) const;

 private:
  struct Copy {
    std::size_t from, to, bytes;
  };
  struct Widen {  // to a double
    std::uint8_t type;
    double scale, added;
    std::optional<double> no_data;  // as it is stored
    std::size_t from, to;
  };
  struct Normal {  // one component, of type 9 or 10
    std::size_t at;
    std::uint8_t type;
  };

  void copy(std::size_t from, std::size_t to, std::size_t bytes);
  void find_extra(const LasHeader& from, const LasForm& to);
  void find_normals(const LasForm& to);
  void move(const std::byte* from, std::byte* to) const;
  void turn(std::byte* record) const;
  std::int32_t stored(double value, std::size_t axis) const;
  [[noreturn]] void fail_range() const;

  std::string name_;
  std::size_t record_bytes_;
  std::array<double, 3> from_scale_, from_offset_, scale_, offset_;
  std::array<LasStep, 3> steps_{};
  bool is_stepped_ = false, is_widened_core_ = false;
  std::optional<Eigen::Affine3d> pose_;
  std::vector<std::byte> empty_;  // a point of the form with nothing of the file
  bool is_whole_ = false;         // nothing of it is left
  std::vector<Copy> copies_;
  std::vector<Widen> widened_;
  std::vector<Normal> normals_;  // three, or none
};

}  // namespace lacuna::io
