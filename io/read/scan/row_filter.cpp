// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/row_filter.hpp"

#include "io/read/files/number.hpp"
#include "io/read/rows/columns.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace lacuna::io {
namespace {

std::optional<Eigen::AlignedBox3d> box_of(std::span<const double> bounds) {
  if (bounds.empty()) return std::nullopt;
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const bool is_flat = bounds.size() == 4;
  const double* const min = bounds.data();
  const double* const max = min + bounds.size() / 2;
  return Eigen::AlignedBox3d(Eigen::Vector3d(min[0], min[1], is_flat ? -kInfinite : min[2]),
                             Eigen::Vector3d(max[0], max[1], is_flat ? kInfinite : max[2]));
}

}  // namespace

RowFilter::RowFilter(const InputConfig& config, const std::filesystem::path& file, const ScanReader& reader)
    : stride_(reader.layout().stride), bounds_(box_of(config.bounds)) {
  for (std::size_t at = 0; at < config.leave_out.size(); at += 6)
    boxes_.push_back(*box_of(std::span(config.leave_out).subspan(at, 6)));
  if (config.drop_origin) no_return_places_ = reader.no_return_places();
  const auto column_if_any = [&](const char* name) -> std::optional<Values> {
    const Property* const property = reader.layout().find_alike(name);
    return property == nullptr ? std::nullopt : std::optional(Values{.property = *property, .values = {}});
  };
  if (!config.keep_withheld) withheld_ = column_if_any("withheld");
  if (!config.keep_noise && reader.has_noise_classes()) class_ = column_if_any("classification");
  synthetic_ = column_if_any("synthetic");
  if (!config.where.empty()) where_.emplace(config.where, file.string(), reader.layout());
  is_active_ =
      config.drop_origin || bounds_ || !boxes_.empty() || withheld_ || class_ || synthetic_ || where_;
}

std::string describe_no_row_left(const InputConfig& config, const FilteredOut& filtered) {
  std::string text = "the filters leave none of the " + std::to_string(filtered.total()) + " points";
  const char* separator = ": ";
  const auto add = [&](const std::string& part) { text += std::exchange(separator, "; ") + part; };
  const auto add_option = [&](const std::string& option, std::uint64_t count) {
    add(option + " leaves out " + std::to_string(count));
  };
  if (config.drop_origin && filtered.origin > 0) add_option("--drop-origin", filtered.origin);
  if (!config.bounds.empty()) add_option("--bounds", filtered.bounds);
  if (const Eigen::AlignedBox3d& before = filtered.bounds_before; !config.bounds.empty() && !before.isEmpty())
    text += ", the scan lies from " + print_point(before.min()) + " to " + print_point(before.max());
  if (!config.leave_out.empty()) add_option("--leave-out", filtered.boxes);
  if (filtered.withheld > 0)
    add(std::to_string(filtered.withheld) + " are withheld, which --keep-withheld keeps");
  if (filtered.noise > 0) add(std::to_string(filtered.noise) + " are noise, which --keep-noise keeps");
  if (!config.where.empty()) add_option("--where", filtered.where);
  return text;
}

void RowFilter::apply(const RowBatch& rows, std::span<Eigen::Vector3d> positions, FilteredOut& filtered) {
  if (!is_active_) return;
  load(rows, withheld_);
  load(rows, class_);
  load(rows, synthetic_);
  if (where_) where_->load(rows);
  for (std::size_t row = 0; row < positions.size(); ++row) {
    Eigen::Vector3d& position = positions[row];
    if (!position.allFinite()) continue;
    std::uint64_t* const count = refusing(row, position, filtered);
    if (count == nullptr) {
      filtered.synthetic += synthetic_ && synthetic_->values[row] != 0;
      continue;
    }
    ++*count;
    position.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

// Returns the count of the first filter that refuses the row; null if none does.
std::uint64_t* RowFilter::refusing(std::size_t row, const Eigen::Vector3d& position,
                                   FilteredOut& filtered) const {
  constexpr double kLowNoise = 7, kHighNoise = 18;
  if (withheld_ && withheld_->values[row] != 0) return &filtered.withheld;
  if (class_ && (class_->values[row] == kLowNoise || class_->values[row] == kHighNoise))
    return &filtered.noise;
  if (std::count(no_return_places_.begin(), no_return_places_.end(), position) > 0) return &filtered.origin;
  if (bounds_) {
    filtered.bounds_before.extend(position);
    if (!bounds_->contains(position)) return &filtered.bounds;
  }
  if (std::any_of(boxes_.begin(), boxes_.end(), [&](const auto& box) { return box.contains(position); }))
    return &filtered.boxes;
  return where_ && !where_->holds(row) ? &filtered.where : nullptr;
}

void RowFilter::load(const RowBatch& rows, std::optional<Values>& column) const {
  if (!column) return;
  load_column(rows, stride_, column->property, column->values);
}

}  // namespace lacuna::io
