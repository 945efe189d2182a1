// SPDX-License-Identifier: Apache-2.0
#include "io/write/report/scene_colours.hpp"

#include "io/read/rows/columns.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/write/report/percentile.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace lacuna::io {
namespace {

constexpr float kRounded = 1.01f;                               // the most that a colour from 0 to 1 may be
constexpr std::pair<double, double> kStretched = {0.02, 0.98};  // percentiles

// The values that become 0 and 255.
std::pair<float, float> range_of(std::span<const float> values, bool is_intensity, Scalar type) {
  if (is_intensity) {
    std::vector<float> sorted(values.begin(), values.end());
    return {percentile(sorted, kStretched.first), percentile(sorted, kStretched.second)};
  }
  const float most = *std::max_element(values.begin(), values.end());
  if (!is_integer(type) && most <= kRounded) return {0.0f, 1.0f};
  return {0.0f, most > 255 ? 65535.0f : 255.0f};
}

}  // namespace

ColourColumns::ColourColumns(const RowLayout& layout) : layout_(layout) {
  const auto [red, green, blue, intensity] = kColourNames;
  if (layout.find(red) && layout.find(green) && layout.find(blue)) {
    properties_ = {layout.find(red), layout.find(green), layout.find(blue)};
  } else if (layout.find(intensity)) {
    properties_ = {layout.find(intensity)};
  }
  loaded_.resize(properties_.size());
}

void ColourColumns::load(const RowBatch& rows) {
  for (std::size_t i = 0; i < properties_.size(); ++i) {
    load_column(rows, layout_.stride, *properties_[i], loaded_[i]);
  }
}

void ColourColumns::take(std::size_t row) {
  for (const std::vector<double>& column : loaded_) {
    taken_.push_back(std::isfinite(column[row]) ? static_cast<float>(column[row]) : 0.0f);
  }
}

void ColourColumns::begin_file() {
  if (taken_.size() > files_.back()) files_.push_back(taken_.size());
}

std::vector<Colour> ColourColumns::finish() const {
  std::vector<Colour> colours;
  if (taken_.empty()) return colours;
  const std::size_t width = properties_.size();
  const bool is_intensity = width == 1;
  colours.reserve(taken_.size() / width);
  for (std::size_t file = 0; file < files_.size(); ++file) {
    const bool is_last = is_intensity || file + 1 == files_.size();  // one range of all intensities
    const std::size_t end = is_last ? taken_.size() : files_[file + 1];
    const std::span values(taken_.data() + files_[file], end - files_[file]);
    if (values.empty()) break;
    const auto [low, high] = range_of(values, is_intensity, properties_.front()->type);
    const auto byte = [low = low, span = std::max(high - low, 1e-30f)](float value) {
      return static_cast<std::uint8_t>(std::clamp((value - low) / span, 0.0f, 1.0f) * 255.0f + 0.5f);
    };
    for (std::size_t i = 0; i < values.size(); i += width)
      colours.push_back({byte(values[i]), byte(values[i + width / 3]), byte(values[i + 2 * (width / 3)])});
    if (is_last) break;
  }
  return colours;
}

}  // namespace lacuna::io
