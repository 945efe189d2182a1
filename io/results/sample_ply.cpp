#include "engine/run/error.hpp"
#include "io/ply/ply_writer.hpp"
#include "io/results/results.hpp"
#include "io/scalar.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

constexpr std::size_t kRowsAtATime = std::size_t{1} << 16;

// Colours of the input that are carried along: with the type that they have in all files, else as doubles.
std::vector<std::pair<std::string, Scalar>> colour_columns(const FileScan& scan) {
  std::vector<std::pair<std::string, Scalar>> columns;
  for (const char* const name : {"red", "green", "blue", "intensity"}) {
    std::optional<Scalar> type;
    for (const RowLayout& layout : scan.layouts()) {
      const Property* property = layout.find(name);
      if (!property) continue;
      type = type.value_or(property->type) == property->type ? property->type : Scalar::kFloat64;
    }
    if (type) columns.emplace_back(name, *type);
  }
  return columns;
}

// Colours of chosen rows, which are asked for in ascending id.
class ColourRows {
 public:
  ColourRows(const FileScan& scan, std::span<const std::pair<std::string, Scalar>> columns)
      : scan_(scan), layout_(packed_layout(columns)), row_(layout_.stride) {}

  std::span<const std::byte> find(PointId id) {
    while (value(id) >= first_ + rows_.count) read_on();
    for (const Property& to : layout_.properties) {
      const Column column{.data = row_.data() + to.offset, .stride = layout_.stride, .type = to.type};
      if (const Property* from = reader_->layout().find(to.name)) {
        const std::size_t stride = reader_->layout().stride;
        const std::byte* row = rows_.bytes.data() + (value(id) - first_) * stride;
        copy_column({.data = row + from->offset, .stride = stride, .type = from->type}, column, 1);
      } else {
        fill_missing(column, 1);
      }
    }
    return row_;
  }

 private:
  void read_on() {
    first_ += rows_.count;
    for (rows_.count = 0; file_ < scan_.files().size(); ++file_, reader_.reset()) {
      if (!reader_) reader_ = scan_.open(file_);
      if (reader_->next(rows_, kRowsAtATime)) return;
    }
    throw Error("the input has changed during the run; it must stay as it is");
  }

  const FileScan& scan_;
  RowLayout layout_;
  std::vector<std::byte> row_;
  std::size_t file_ = 0;
  std::unique_ptr<ScanReader> reader_;
  RowBatch rows_;
  std::uint64_t first_ = 0;  // id of the first row in memory
};

}  // namespace

void write_sample(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                  OutputFile& out) {
  PlyElement vertex{
      .name = "vertex", .count = detection.sampled_points(), .properties = position_and_id(detection, scan)};
  const Scalar coordinate = vertex.properties.front().type;
  const Scalar id = vertex.properties.back().type;
  for (const char* const name : {"nx", "ny", "nz", "scalar_probability"})
    vertex.properties.push_back({name, Scalar::kFloat32, {}});
  const bool with_colours = config.report || !scan.reads_slowly();
  const auto columns = with_colours ? colour_columns(scan) : decltype(colour_columns(scan)){};
  for (const auto& [name, type] : columns) vertex.properties.push_back({name, type, {}});
  PlyWriter writer(out, {vertex});

  ColourRows colours(scan, columns);
  detection.for_each_sampled_point([&](const SampledPoint& point) {
    for (const double component : point.position) writer.put_as(coordinate, component);
    writer.put_as(id, static_cast<double>(value(point.id)));
    for (const float component : point.normal) writer.put(component);
    writer.put(point.probability);
    if (!columns.empty()) writer.put_bytes(colours.find(point.id));
  });
  writer.finish();
}

}  // namespace lacuna
