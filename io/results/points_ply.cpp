#include "engine/criteria/criteria.hpp"
#include "engine/run/error.hpp"
#include "io/ply/ply_writer.hpp"
#include "io/results/results.hpp"
#include "io/scalar.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <optional>
#include <string_view>
#include <unordered_map>

namespace lacuna {
namespace {

constexpr std::size_t kBlockRows = std::size_t{1} << 14;

// A result: its name, its type and where it stands in a PointResult.
struct ResultColumn {
  std::string name;
  Scalar type;
  std::function<const void*(const PointResult& result)> find;
};

std::vector<ResultColumn> result_columns(bool with_normals) {
  using R = const PointResult&;
  using P = const void*;
  std::vector<ResultColumn> columns = {
      {"scalar_probability", Scalar::kFloat32, [](R r) -> P { return &r.probability; }}};
  for (const Criterion& criterion : criteria()) {
    const std::size_t i = columns.size() - 1;
    columns.push_back({criterion.column, Scalar::kFloat32, [i](R r) -> P { return &r.criteria[i]; }});
  }
  columns.push_back({"scalar_boundary", Scalar::kUint8, [](R r) -> P { return &r.boundary; }});
  columns.push_back({"scalar_coherent", Scalar::kUint8, [](R r) -> P { return &r.coherent; }});
  columns.push_back({"scalar_loop", Scalar::kInt32, [](R r) -> P { return &r.loop; }});
  if (with_normals) {
    columns.push_back({"nx", Scalar::kFloat32, [](R r) -> P { return &r.normal.x(); }});
    columns.push_back({"ny", Scalar::kFloat32, [](R r) -> P { return &r.normal.y(); }});
    columns.push_back({"nz", Scalar::kFloat32, [](R r) -> P { return &r.normal.z(); }});
  }
  return columns;
}

// The union of the files' properties, in order of first appearance.
std::vector<std::pair<std::string, Scalar>> join_properties(const std::vector<RowLayout>& layouts,
                                                            const std::vector<ResultColumn>& results) {
  std::vector<std::pair<std::string, Scalar>> joined;
  std::unordered_map<std::string_view, std::size_t> place_of;  // in `joined`
  for (const RowLayout& layout : layouts) {
    for (const Property& property : layout.properties) {
      if (std::any_of(results.begin(), results.end(),
                      [&](const auto& r) { return r.name == property.name; })) {
        continue;
      }
      const auto [known, is_new] = place_of.try_emplace(property.name, joined.size());
      if (is_new) {
        joined.emplace_back(property.name, property.type);
      } else if (Scalar& type = joined[known->second].second; type != property.type) {
        type = Scalar::kFloat64;
      }
    }
  }
  return joined;
}

// For each of the columns: the property of that name; null where a file has none.
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

// The rows of all files once more, in order, for the columns of points.ply that come from them.
class RowStream {
 public:
  RowStream(const FileScan& scan, std::span<const Property> columns) : scan_(scan), columns_(columns) {}

  // At most `max_rows` of one file; empty at the end.
  const RowBatch& next(std::size_t max_rows) {
    for (; file_ < scan_.files().size(); ++file_, reader_.reset()) {
      if (!reader_) {
        reader_ = scan_.open(file_);
        sources_ = find_sources(reader_->layout(), columns_);
      }
      if (reader_->next(rows_, max_rows)) return rows_;
    }
    rows_.count = 0;
    return rows_;
  }

  // The rows last returned, into rows of `stride` bytes.
  void copy_columns(std::size_t stride, std::byte* out) const {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const Column column{.data = out + columns_[i].offset, .stride = stride, .type = columns_[i].type};
      if (const Property* source = sources_[i]) {
        copy_column({.data = rows_.bytes.data() + source->offset,
                     .stride = reader_->layout().stride,
                     .type = source->type},
                    column, rows_.count);
      } else {
        fill_missing(column, rows_.count);
      }
    }
  }

 private:
  const FileScan& scan_;
  std::span<const Property> columns_;
  std::vector<const Property*> sources_;  // in the reader's layout, one for each column
  std::size_t file_ = 0;
  std::unique_ptr<ScanReader> reader_;
  RowBatch rows_;
};

void copy_results(std::span<const PointResult> results, const std::vector<ResultColumn>& columns,
                  const RowLayout& to, std::byte* out) {
  if (results.empty()) return;
  const std::size_t before = to.properties.size() - columns.size();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::size_t bytes = size_of(columns[i].type);
    std::byte* const place = out + to.properties[before + i].offset;
    const auto* from = static_cast<const std::byte*>(columns[i].find(results.front()));
    for (std::size_t row = 0; row < results.size(); ++row) {
      std::memcpy(place + row * to.stride, from + row * sizeof(PointResult), bytes);
    }
  }
}

// What a row of points.ply holds: the input's columns, then the results.
struct PointColumns {
  std::vector<ResultColumn> results;
  std::vector<std::pair<std::string, Scalar>> all;

  PointColumns(const FileScan& scan, const OutputConfig& config)
      : results(result_columns(config.normals && !scan.has_normals())),
        all(join_properties(scan.layouts(), results)) {
    for (const ResultColumn& result : results) all.emplace_back(result.name, result.type);
  }
};

[[noreturn]] void fail_changed(const OutputFile& out) {
  throw Error(out.path().string() + ": the input has changed during the run; it must stay as it is");
}

}  // namespace

std::uint64_t point_row_bytes(const FileScan& scan, const OutputConfig& config) {
  return packed_layout(PointColumns(scan, config).all).stride;
}

void write_points(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                  OutputFile& out) {
  const PointColumns columns(scan, config);
  const std::vector<ResultColumn>& results = columns.results;
  const std::size_t input_columns = columns.all.size() - results.size();
  const RowLayout layout = packed_layout(columns.all);

  PlyElement vertex{.name = "vertex", .count = detection.summary().counts.points, .properties = {}};
  for (const auto& [name, type] : columns.all) vertex.properties.push_back({name, type, {}});
  PlyWriter writer(out, {vertex});

  RowStream input(scan, std::span(layout.properties).first(input_columns));
  std::vector<std::byte> block;
  detection.for_each_result_block([&](PointId, std::span<const PointResult> left) {
    while (!left.empty()) {
      const RowBatch& rows = input.next(std::min(left.size(), kBlockRows));
      if (rows.count == 0) fail_changed(out);
      block.resize(rows.count * layout.stride);
      input.copy_columns(layout.stride, block.data());
      copy_results(left.first(rows.count), results, layout, block.data());
      writer.put_bytes(block);
      left = left.subspan(rows.count);
    }
  });
  if (input.next(1).count != 0) fail_changed(out);
  writer.finish();
}

}  // namespace lacuna
