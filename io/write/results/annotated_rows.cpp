// SPDX-License-Identifier: Apache-2.0
#include "io/write/results/annotated_rows.hpp"

#include "engine/criteria/criteria.hpp"
#include "io/read/rows/columns.hpp"

#include <algorithm>
#include <cstring>
#include <unordered_map>
#include <utility>

namespace lacuna::io {
namespace {

// Returns the property with the name of each column; null if a file has none.
std::vector<const Property*> find_sources(const RowLayout& from, std::span<const Property> columns) {
  std::unordered_map<std::string_view, const Property*> by_name;
  for (const Property& property : from.properties) by_name.emplace(property.name, &property);
  std::vector<const Property*> sources;
  for (const Property& column : columns) {
    const auto found = by_name.find(column.name);
    sources.push_back(found == by_name.end() ? nullptr : found->second);
  }
  return sources;
}

}  // namespace

std::vector<ResultColumn> result_columns(const ScanFiles& scan, const OutputConfig& config) {
  const PointResult sample{};
  std::vector<ResultColumn> columns;
  const auto add = [&](std::string name, Scalar type, const void* place) {
    const auto offset = static_cast<const std::byte*>(place) - reinterpret_cast<const std::byte*>(&sample);
    columns.push_back({std::move(name), type, static_cast<std::size_t>(offset)});
  };
  add("scalar_probability", Scalar::kFloat32, &sample.probability);
  for (std::size_t i = 0; i < criteria().size(); ++i)
    add(criteria()[i].column, Scalar::kFloat32, &sample.criteria[i]);
  add("scalar_boundary", Scalar::kUint8, &sample.boundary);
  add("scalar_coherent", Scalar::kUint8, &sample.coherent);
  add("scalar_loop", Scalar::kInt32, &sample.loop);
  if (config.points_normals && !scan.has_normals()) {
    add("nx", Scalar::kFloat32, &sample.normal[0]);
    add("ny", Scalar::kFloat32, &sample.normal[1]);
    add("nz", Scalar::kFloat32, &sample.normal[2]);
  }
  return columns;
}

bool is_earlier_quality(const RowLayout& layout, std::size_t index) {
  return layout.properties[index].name == kQuality && index > 0 &&
         layout.properties[index - 1].name == kBeforeQuality;
}

bool is_earlier_result(const RowLayout& layout, std::size_t index, std::span<const ResultColumn> results) {
  const auto is_result = [&](std::string_view name) {
    return std::any_of(results.begin(), results.end(),
                       [&](const auto& result) { return result.name == name; });
  };
  const std::string& name = layout.properties[index].name;
  if (name == kQuality) return is_earlier_quality(layout, index) && is_result(kBeforeQuality);
  return is_result(name);
}

std::size_t bytes_of(std::span<const ResultColumn> results) {
  std::size_t bytes = 0;
  for (const ResultColumn& result : results) bytes += size_of(result.type);
  return bytes;
}

RowLayout join_layouts(std::span<const RowLayout> layouts, const LeftOut& is_left_out) {
  std::vector<std::pair<std::string, Scalar>> joined;
  std::unordered_map<std::string_view, std::size_t> place_of;  // in `joined`
  for (const RowLayout& layout : layouts) {
    for (std::size_t i = 0; i < layout.properties.size(); ++i) {
      const Property& property = layout.properties[i];
      if (is_left_out(layout, i)) continue;
      const auto [known, is_new] = place_of.try_emplace(property.name, joined.size());
      if (is_new) {
        joined.emplace_back(property.name, property.type);
      } else if (Scalar& type = joined[known->second].second; type != property.type) {
        type = Scalar::kFloat64;
      }
    }
  }
  return packed_layout(joined);
}

void copy_results(std::span<const PointResult> results, std::span<const ResultColumn> columns,
                  std::size_t stride, std::byte* out) {
  if (results.empty()) return;
  for (const ResultColumn& column : columns) {
    const std::size_t bytes = size_of(column.type);
    const auto* from = reinterpret_cast<const std::byte*>(results.data()) + column.offset;
    for (std::size_t row = 0; row < results.size(); ++row) {
      std::memcpy(out + row * stride, from + row * sizeof(PointResult), bytes);
    }
    out += bytes;
  }
}

JoinedRows::JoinedRows(const ScanFiles& scan, RowLayout joined, IndexRange files, const LocalOffset& offset)
    : scan_(scan), joined_(std::move(joined)), file_(files.first), end_(files.last) {
  LocalOffset added;
  if (offset) added = -*offset;
  for (const Property& column : joined_.properties) summands_.push_back(component_of(added, column.name));
}

std::size_t JoinedRows::next(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) {
  for (; file_ < end_; ++file_, reader_.reset()) {
    if (!reader_) {
      reader_ = scan_.open_in_own_units(file_);
      sources_ = find_sources(reader_->layout(), joined_.properties);
    }
    if (!reader_->next(rows_, std::min(max_rows, scan_.batch_rows(file_)))) continue;
    block.resize(rows_.count * stride);
    copy_columns(stride, block.data());
    return rows_.count;
  }
  return 0;
}

void JoinedRows::copy_columns(std::size_t stride, std::byte* out) const {
  for (std::size_t i = 0; i < joined_.properties.size(); ++i) {
    const Property& to = joined_.properties[i];
    const Column column{.data = out + to.offset, .stride = stride, .type = to.type};
    if (sources_[i] == nullptr) {
      fill_missing(column, rows_.count);
      continue;
    }
    copy_column(column_of(rows_, reader_->layout().stride, *sources_[i]), summands_[i], column, rows_.count);
  }
}

}  // namespace lacuna::io
