// SPDX-License-Identifier: Apache-2.0
#include "io/write/results/points_form.hpp"

#include "engine/criteria/criteria.hpp"
#include "engine/run/error.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/words.hpp"
#include "io/read/files/number.hpp"
#include "io/read/las/las_header.hpp"
#include "io/read/las/las_points.hpp"
#include "io/read/laz/laz.hpp"
#include "io/read/ply/ply.hpp"
#include "io/read/rows/columns.hpp"
#include "io/write/results/results.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <type_traits>
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

namespace {

// Rows of scalars as lines of text, divided by commas, with a header line.

constexpr std::string_view kReplacement = "\xef\xbf\xbd";  // U+FFFD

bool is_plain(const std::string& name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const std::string lower = lower_case(name);
  const bool is_number = lower.starts_with("nan") || lower.starts_with("inf");
  return !name.empty() && is_letter(name.front()) && !is_number;
}

// Returns text that stays one cell, in UTF-8, and that no program takes for a formula.
std::string safe_name(std::string_view name) {
  constexpr std::string_view kFormulas = "=+-@";
  std::string safe;
  while (!name.empty()) {
    const std::size_t length = utf8_length(name);
    const std::string_view character = name.substr(0, std::max<std::size_t>(length, 1));
    if (length == 0) {
      safe += kReplacement;
    } else if (is_control(character) || character == "," || character == ";" || character == "\"") {
      safe += '_';
    } else {
      safe += character;
    }
    name.remove_prefix(character.size());
  }
  const std::size_t begin = safe.find_first_not_of(' ');
  const bool is_formula = begin != safe.npos && kFormulas.find(safe[begin]) != kFormulas.npos;
  return is_formula ? "_" + safe : safe;
}

std::vector<std::string> header_names(const RowLayout& layout) {
  std::vector<std::string> names;
  std::set<std::string> given;
  for (const Property& property : layout.properties) {
    const std::string name = safe_name(property.name);
    std::string unique = name;
    for (int i = 2; !given.insert(unique).second; ++i) unique = name + '_' + std::to_string(i);
    names.push_back(is_plain(unique) ? unique : '"' + unique + '"');
  }
  return names;
}

template <class T>
void append_value(std::string& text, T value) {
  if constexpr (!std::is_floating_point_v<T>) {
    text += std::to_string(value);
  } else if (std::isnan(value)) {
    text += "nan";  // whatever its sign
  } else {
    append_shortest(text, value);
  }
}

std::string lines_of(std::span<const std::byte> rows, const RowLayout& layout) {
  std::string text;
  for (; !rows.empty(); rows = rows.subspan(layout.stride)) {
    char separator = '\0';
    for (const Property& property : layout.properties) {
      if (std::exchange(separator, ',') != '\0') text += ',';
      with_type(property.type,
                [&](auto zero) { append_value(text, load<decltype(zero)>(&rows[property.offset])); });
    }
    text += '\n';
  }
  return text;
}

class CsvWriter final : public RowsWriter {
 public:
  // Writes the header line. Names are changed or quoted where this project's reader, or another, would
  // misread them. The characters ',' ';' '"' and control characters become '_'. A '_' comes before = + - and
  // @ at the start, which are formulas to a spreadsheet. Bytes that are not UTF-8 become U+FFFD. A name that
  // could be a number or a comment is put in quotes. A second equal name gets a number.
  CsvWriter(OutputFile& out, RowLayout layout) : out_(out), layout_(std::move(layout)) {
    std::string line;
    for (const std::string& name : header_names(layout_)) line += (line.empty() ? "" : ",") + name;
    out_.write(line + '\n');
  }

  // Writes rows of the layout, one after the other. Each number is the shortest text that reads back as the
  // same value of its type; `nan` has no sign. Several threads format; the bytes do not depend on them.
  void put_rows(std::span<const std::byte> rows) override {
    constexpr std::size_t kTogether = 2048;
    const std::size_t count = rows.size() / layout_.stride;
    std::vector<std::string> texts((count + kTogether - 1) / kTogether);
    for_each_here(texts.size(), [&](std::size_t i) {
      const std::size_t first = i * kTogether, together = std::min(kTogether, count - first);
      texts[i] = lines_of(rows.subspan(first * layout_.stride, together * layout_.stride), layout_);
    });
    for (const std::string& text : texts) out_.write(text);
  }

 private:
  OutputFile& out_;
  RowLayout layout_;
};

// Rows of files of any formats, joined by the names of columns.
class JoinedForm : public PointsForm {
 public:
  JoinedForm(const PointsPlan& plan, const std::vector<RowLayout>& layouts)
      : scan_(plan.scan),
        files_(plan.files),
        offset_(plan.offset),
        results_(plan.results),
        input_(join_layouts(
            std::span(layouts).subspan(files_.first, files_.last - files_.first),
            [&](const RowLayout& layout, std::size_t i) { return is_earlier_result(layout, i, results_); })) {
  }
  std::size_t row_bytes() const final { return input_.stride; }
  std::unique_ptr<InputRows> open() const final {
    return std::make_unique<JoinedRows>(scan_, input_, files_, offset_);
  }

 protected:
  // The columns of the rows, then the columns of the results.
  RowLayout with_results() const {
    RowLayout all = input_;
    for (const ResultColumn& result : results_) {
      all.properties.push_back({.name = result.name, .type = result.type, .offset = all.stride});
      all.stride += size_of(result.type);
    }
    return all;
  }
  const LocalOffset& offset() const { return offset_; }

 private:
  const ScanFiles& scan_;
  IndexRange files_;
  LocalOffset offset_;
  std::vector<ResultColumn> results_;
  RowLayout input_;
};

class CsvForm final : public JoinedForm {
 public:
  using JoinedForm::JoinedForm;
  std::unique_ptr<RowsWriter> writer(OutputFile& out, std::uint64_t) const override {
    return std::make_unique<CsvWriter>(out, with_results());
  }
};

class PlyForm final : public JoinedForm {
 public:
  using JoinedForm::JoinedForm;
  std::unique_ptr<RowsWriter> writer(OutputFile& out, std::uint64_t rows) const override {
    PlyElement vertex{.name = "vertex", .count = rows, .properties = {}};
    for (const Property& property : with_results().properties)
      vertex.properties.push_back({property.name, property.type, {}});
    return std::make_unique<PlyWriter>(out, std::vector{std::move(vertex)}, offset());
  }
};

}  // namespace

std::unique_ptr<PointsForm> csv_form(const PointsPlan& plan) {
  return std::make_unique<CsvForm>(plan, layouts_of(plan.scan));
}

std::unique_ptr<PointsForm> ply_form(const PointsPlan& plan) {
  return std::make_unique<PlyForm>(plan, written_layouts(plan.scan, plan.config));
}

namespace {

constexpr const char* kWayOut = "; --points-format ply holds them all";

// Bytes of a record that stay, one after the other in the new record.
struct Kept {
  std::size_t at, bytes;
};

// The parts of a LAS file that go over: all but the results of an earlier run.
struct LasInput {
  LasHeader header;
  std::vector<LasExtraBytes> extra;
  std::vector<Kept> kept;
  std::size_t record_bytes = 0;  // of what is kept
};

LasInput examine(const std::filesystem::path& file) {
  InputFile in(file);
  LasInput input{.header = read_las_header(in), .extra = {}, .kept = {}};
  std::size_t at = las_point_bytes(input.header.point_format);
  const auto keep = [&](std::size_t from, std::size_t bytes) {
    input.kept.push_back({from, bytes});
    input.record_bytes += bytes;
  };
  keep(0, at);
  for (const LasExtraBytes& extra : las_extra_of_points(input.header)) {
    const std::size_t bytes = las_extra_size(extra), place = std::exchange(at, at + bytes);
    if (is_lacuna_extra(extra)) continue;
    keep(place, bytes);
    input.extra.push_back(extra);
  }
  return input;
}

// Its header counts the points that were read: those that `--trust` chose.
LasHeader header_as_read(InputFile& in, const ScanFile& file) {
  LasHeader header = read_las_header(in);
  header.points = file.expected_rows.value();
  return header;
}

// Reads the points of the file as records of the parts that are kept.
class LasRows final : public InputRows {
 public:
  LasRows(const ScanFiles& scan, std::size_t file, const std::vector<Kept>& kept)
      : in_(scan.files()[file].name),
        header_(header_as_read(in_, scan.files()[file])),
        // Its counts were checked when the scan was read.
        points_(las_points(in_, header_, Trust::kHeader, scan.memory())),
        kept_(kept),
        most_rows_(scan.batch_rows(file)),
        left_(header_.points) {}

  std::size_t next(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) override {
    const std::uint64_t most = std::min(
        {max_rows, most_rows_,
         std::max<std::size_t>(1, kBatchBytes / std::max<std::size_t>(stride, header_.record_bytes))});
    const auto count = static_cast<std::size_t>(std::min(left_, most));
    if (count == 0) return 0;
    records_.resize(count * header_.record_bytes);
    points_->read(records_);
    left_ -= count;
    block.resize(count * stride);
    for (std::size_t row = 0; row < count; ++row) {
      std::byte* to = &block[row * stride];
      for (const Kept& part : kept_) {
        std::memcpy(to, &records_[row * header_.record_bytes + part.at], part.bytes);
        to += part.bytes;
      }
    }
    return count;
  }

 private:
  InputFile in_;
  LasHeader header_;
  std::unique_ptr<LasPoints> points_;
  const std::vector<Kept>& kept_;
  std::size_t most_rows_;
  std::uint64_t left_;
  std::vector<std::byte> records_;
};

// Adds "probability" and so on; where the input has extra bytes of that name from elsewhere,
// "lacuna_probability".
void add_results(std::span<const ResultColumn> results, std::vector<LasExtraBytes>& extra) {
  constexpr std::string_view kPrefix = "scalar_";
  const std::vector<LasExtraBytes> given = extra;
  for (const ResultColumn& result : results) {
    std::string name = result.name;
    if (name.starts_with(kPrefix)) name.erase(0, kPrefix.size());
    // Normals are the next run's input, not a result that it replaces.
    const bool is_normal = name == result.name;
    const std::string description = is_normal ? "estimated normal" : std::string(kLacunaDescription) + name;
    const auto is_taken = [&](const LasExtraBytes& other) { return other.name == name; };
    while (std::any_of(given.begin(), given.end(), is_taken)) name.insert(0, "lacuna_");
    extra.push_back(las_extra_of(name, result.type, description));
  }
}

class LasForm final : public PointsForm {
 public:
  explicit LasForm(const PointsPlan& plan)
      : scan_(plan.scan), file_(plan.files.first), input_(examine(scan_.files()[file_].name)) {
    constexpr std::size_t kMostRecordBytes = 65535, kMostDescriptors = 341;  // 192 bytes each in 65535
    const std::size_t extra = input_.extra.size();
    written_bytes_ = input_.record_bytes + bytes_of(plan.results);
    add_results(plan.results, input_.extra);
    if (written_bytes_ > kMostRecordBytes || input_.extra.size() > kMostDescriptors)
      throw Error(plan.name + ": " + std::to_string(extra) + " extra values and " +
                  std::to_string(input_.record_bytes) +
                  " bytes a point leave no room for the results in LAS" + kWayOut);
    if (input_.header.is_compressed) compress(plan.name);
  }

  std::size_t row_bytes() const override { return input_.record_bytes; }
  std::unique_ptr<InputRows> open() const override {
    return std::make_unique<LasRows>(scan_, file_, input_.kept);
  }
  std::unique_ptr<RowsWriter> writer(OutputFile& out, std::uint64_t) const override {
    return std::make_unique<LasWriter>(out, scan_.files()[file_].name, input_.header, input_.extra,
                                       written_bytes_, compression_);
  }

 private:
  void compress(const std::string& name) {
    const int format = input_.header.point_format;
    const auto extra = static_cast<std::uint16_t>(written_bytes_ - las_point_bytes(format));
    const laz::Layout layout = laz::layout_of(format, extra);
    const std::uint64_t needed = laz::encoder_bytes(layout) + laz::kMostChunkBytes;
    if (needed > scan_.memory())
      throw Error(name + ": to compress points of " + std::to_string(layout.record_bytes()) +
                  " bytes takes " + std::to_string(needed >> 20) + " MiB, more than the " +
                  std::to_string(scan_.memory() >> 20) + " MiB that the memory limit leaves for it" +
                  kWayOut);
    compression_ = {.layout = layout, .memory = scan_.memory() / 2};  // the other half is for reading
  }

  const ScanFiles& scan_;
  std::size_t file_;
  LasInput input_;
  std::size_t written_bytes_ = 0;  // of a record, with results
  std::optional<LasCompression> compression_;
};

}  // namespace

bool is_compressed_las(const std::filesystem::path& file) {
  InputFile in(file);
  return read_las_header(in).is_compressed;
}

std::unique_ptr<PointsForm> las_form(const PointsPlan& plan) {
  return std::make_unique<LasForm>(plan);
}

}  // namespace lacuna::io
