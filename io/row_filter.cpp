#include "io/row_filter.hpp"

#include "engine/run/error.hpp"
#include "io/property_name.hpp"
#include "io/vectors.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace lacuna::io {
namespace {

std::optional<Eigen::AlignedBox3d> box_of(const std::vector<double>& bounds) {
  if (bounds.empty()) return std::nullopt;
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const bool is_flat = bounds.size() == 4;
  const double* const min = bounds.data();
  const double* const max = min + bounds.size() / 2;
  return Eigen::AlignedBox3d(Eigen::Vector3d(min[0], min[1], is_flat ? -kInfinite : min[2]),
                             Eigen::Vector3d(max[0], max[1], is_flat ? kInfinite : max[2]));
}

Property find_property(const std::filesystem::path& file, const RowLayout& layout, const char* name,
                       const char* option) {
  for (const Property& property : layout.properties) {
    if (bare_name(property.name) == bare_name(name)) return property;
  }
  throw Error(file.string() + ": its points have no " + name + ", which " + option + " needs");
}

}  // namespace

RowFilter::RowFilter(const InputConfig& config, const std::filesystem::path& file, const ScanReader& reader)
    : stride_(reader.layout().stride),
      bounds_(box_of(config.bounds)),
      chosen_classes_(config.classes),
      chosen_returns_(config.returns) {
  const auto column = [&](const char* name, const char* option) {
    return Values{.property = find_property(file, reader.layout(), name, option), .values = {}};
  };
  if (config.drop_origin) no_return_places_ = reader.no_return_places();
  if (!chosen_classes_.empty()) class_ = column("classification", "--classes");
  if (chosen_returns_ == Returns::kFirst || chosen_returns_ == Returns::kLast)
    return_number_ = column("return_number", "--returns");
  if (chosen_returns_ == Returns::kLast || chosen_returns_ == Returns::kOnly)
    number_of_returns_ = column("number_of_returns", "--returns");
  is_active_ = config.drop_origin || bounds_ || class_ || return_number_ || number_of_returns_;
}

void RowFilter::apply(const RowBatch& rows, std::span<Eigen::Vector3d> positions, FilteredOut& filtered) {
  if (!is_active_) return;
  load(rows, class_);
  load(rows, return_number_);
  load(rows, number_of_returns_);
  for (std::size_t row = 0; row < positions.size(); ++row) {
    Eigen::Vector3d& position = positions[row];
    if (!position.allFinite()) continue;
    std::uint64_t* const count = is_no_return(position)                    ? &filtered.origin
                                 : bounds_ && !bounds_->contains(position) ? &filtered.bounds
                                 : !has_chosen_class(row)                  ? &filtered.classes
                                 : !is_chosen_return(row)                  ? &filtered.returns
                                                                           : nullptr;
    if (count == nullptr) continue;
    ++*count;
    position.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

void RowFilter::load(const RowBatch& rows, std::optional<Values>& column) const {
  if (!column) return;
  load_column(rows, stride_, column->property, column->values);
}

bool RowFilter::is_no_return(const Eigen::Vector3d& position) const {
  return std::find(no_return_places_.begin(), no_return_places_.end(), position) != no_return_places_.end();
}

bool RowFilter::has_chosen_class(std::size_t row) const {
  return !class_ || std::any_of(chosen_classes_.begin(), chosen_classes_.end(), [&](std::int64_t chosen) {
    return class_->values[row] == static_cast<double>(chosen);
  });
}

bool RowFilter::is_chosen_return(std::size_t row) const {
  switch (chosen_returns_) {
    case Returns::kAll:
      break;
    case Returns::kFirst:
      return return_number_->values[row] == 1;
    case Returns::kLast:
      return return_number_->values[row] == number_of_returns_->values[row];
    case Returns::kOnly:
      return number_of_returns_->values[row] == 1;
  }
  return true;
}

}  // namespace lacuna::io
