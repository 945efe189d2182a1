// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/las/las_import.hpp"
#include "io/las/las_points.hpp"
#include "io/las/las_transfer.hpp"
#include "io/las/las_writer.hpp"
#include "io/laz/laz_encoder.hpp"
#include "io/little_endian.hpp"
#include "io/results/annotated_rows.hpp"
#include "io/results/points.hpp"
#include "io/results/points_form.hpp"
#include "io/scalar.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace lacuna::io {
namespace {

constexpr std::size_t kBatchBytes = std::size_t{32} << 20;

bool is_las(const FileScan& scan, std::size_t file) {
  return scan.formats()[file].starts_with("LA");
}

// What of the scan becomes points of LAS.
struct LasInput {
  LasParts parts;
  std::optional<LasOrigin> origin;  // the first LAS file
  RowLayout others;                 // of the files of other formats, joined
};

LasInput examine(const PointsPlan& plan) {
  const FileScan& scan = plan.scan;
  LasInput input;
  input.parts.keeps_results = plan.keeps_earlier;
  input.parts.name = plan.name;
  std::vector<RowLayout> others;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    const auto& file = scan.files()[i];
    if (!is_las(scan, i)) {
      others.push_back(scan.layouts()[i]);
      continue;
    }
    InputFile in(file);
    LasPart part{
        .name = file.string(), .header = read_las_header(in), .has_pose = scan.poses()[i].has_value()};
    if (!input.origin) {
      const bool has_crs = !part.has_pose && scan.crs()[i] == scan.common_crs();
      input.origin = {.file = file, .header = part.header, .has_crs = has_crs, .has_counts = false};
    }
    input.parts.las.push_back(std::move(part));
  }
  input.others = join_layouts(others, [&](const RowLayout& layout, std::size_t i) {
    return is_earlier_result(layout, i, plan.results);
  });
  for (const Property& property : input.others.properties)
    input.parts.imported.push_back({.property = property});
  input.parts.crs = scan.common_crs();
  return input;
}

// Whether no coordinate changes.
bool has_one_scale(const LasParts& parts) {
  return parts.imported.empty() && std::all_of(parts.las.begin(), parts.las.end(), [&](const LasPart& part) {
           return !part.has_pose && part.header.scale == parts.las.front().header.scale &&
                  part.header.offset == parts.las.front().header.offset;
         });
}

// Reads what the files of other formats hold, and, where coordinates change, where the points of LAS files
// are: their headers may be wrong.
void survey(const FileScan& scan, LasInput& input) {
  if (has_one_scale(input.parts)) return;
  std::optional<ImportSurvey> others;
  if (!input.parts.imported.empty()) others.emplace(input.others);
  const RowLayout place = packed_layout(std::vector<std::pair<std::string, Scalar>>{
      {"x", Scalar::kFloat64}, {"y", Scalar::kFloat64}, {"z", Scalar::kFloat64}});
  ImportSurvey moved(place);
  std::vector<std::byte> block;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    const RowLayout& layout = is_las(scan, i) ? place : input.others;
    const auto rows = joined_rows(scan, layout, i, i + 1);
    constexpr std::size_t kRows = std::size_t{1} << 14;
    while (rows->next(kRows, layout.stride, block) > 0) (is_las(scan, i) ? moved : *others).take(block);
  }
  input.parts.bounds = moved.bounds();
  if (!others) return;
  input.parts.bounds.extend(others->bounds());
  input.parts.imported = others->columns();
}

// The points of all files as records of the form.
class LasRows final : public InputRows {
 public:
  LasRows(const FileScan& scan, const LasInput& input, const LasForm& form)
      : scan_(scan), input_(input), form_(form) {}

  std::size_t next(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) override {
    left_out_.clear();
    const std::size_t fitting = std::max<std::size_t>(1, kBatchBytes / stride);
    for (; file_ < scan_.files().size(); ++file_, close()) {
      if (!transfer_ && !rows_) open();
      const std::size_t count = transfer_ ? next_records(std::min(max_rows, fitting), stride, block)
                                          : next_rows(std::min(max_rows, fitting), stride, block);
      if (count > 0) return count;
    }
    return 0;
  }

  std::span<const std::size_t> left_out() const override { return left_out_; }

  void positions(std::vector<Eigen::Vector3d>& positions) const override {
    if (rows_) return rows_->positions(positions);
    const std::size_t stride = header_.record_bytes;
    const std::optional<Pose>& pose = scan_.poses()[file_];
    positions.resize(records_.size() / stride);
    for (std::size_t row = 0; row < positions.size(); ++row) {
      Eigen::Vector3d& position = positions[row];
      for (std::size_t axis = 0; axis < 3; ++axis)
        position[static_cast<Eigen::Index>(axis)] =
            load<std::int32_t>(&records_[row * stride + 4 * axis]) * header_.scale[axis] +
            header_.offset[axis];
      if (pose) position = *pose * position;
    }
  }

 private:
  void open() {
    if (!is_las(scan_, file_)) {
      rows_ = joined_rows(scan_, input_.others, file_, file_ + 1);
      return;
    }
    const auto& file = scan_.files()[file_];
    in_ = std::make_unique<InputFile>(file);
    header_ = read_las_header(*in_);
    points_ = las_points(*in_, header_, scan_.memory());
    left_ = header_.points;
    transfer_.emplace(file.string(), header_, form_, scan_.poses()[file_]);
  }

  void close() {
    rows_.reset();
    points_.reset();
    transfer_.reset();
  }

  std::size_t next_records(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) {
    const std::uint64_t most = std::min(
        {max_rows, scan_.batch_rows(file_), std::max<std::size_t>(1, kBatchBytes / header_.record_bytes)});
    const auto count = static_cast<std::size_t>(std::min(left_, most));
    if (count == 0) return 0;
    records_.resize(count * header_.record_bytes);
    points_->read(records_);
    left_ -= count;
    block.resize(count * stride);
    transfer_->convert(records_, stride, block.data());
    return count;
  }

  std::size_t next_rows(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) {
    const std::size_t count = rows_->next(max_rows, input_.others.stride, records_);
    if (count == 0) return 0;
    block.resize(count * stride);
    import_las_rows(input_.others, form_, std::span(records_).first(count * input_.others.stride), stride,
                    block.data(), left_out_);
    return count;
  }

  const FileScan& scan_;
  const LasInput& input_;
  const LasForm& form_;
  std::size_t file_ = 0;
  std::unique_ptr<InputRows> rows_;  // of a file of another format
  std::unique_ptr<InputFile> in_;    // a LAS file, and what is read of it
  LasHeader header_;
  std::unique_ptr<LasPoints> points_;
  std::optional<LasTransfer> transfer_;
  std::uint64_t left_ = 0;
  std::vector<std::byte> records_;
  std::vector<std::size_t> left_out_;
};

// "probability" and so on; where the input has extra bytes of that name from elsewhere, "lacuna_probability".
std::vector<LasExtraBytes> result_extra(std::span<const ResultColumn> results, const LasForm& form) {
  constexpr std::string_view kPrefix = "scalar_";
  std::vector<LasExtraBytes> extra;
  for (const ResultColumn& result : results) {
    std::string name = result.name;
    if (name.starts_with(kPrefix)) name.erase(0, kPrefix.size());
    // Normals are the next run's input, not a result that it replaces.
    const bool is_normal = name == result.name;
    const std::string description = is_normal ? "estimated normal" : std::string(kLacunaDescription) + name;
    const auto is_taken = [&](const LasExtraField& field) { return field.what.name == name; };
    while (std::any_of(form.extra.begin(), form.extra.end(), is_taken)) name.insert(0, "lacuna_");
    extra.push_back(las_extra_of(name, result.type, description));
  }
  return extra;
}

// How a LAZ file has these points. Throws `Error` where it cannot.
LasCompression compression_of(const LasForm& form, const PointsPlan& plan) {
  const FileScan& scan = plan.scan;
  const std::string& name = plan.name;
  constexpr const char* kWayOut = "; --points-format las holds them all";
  const std::size_t extra = form.record_bytes + bytes_of(plan.results) - las_point_bytes(form.point_format);
  const auto layout = laz::layout_of(form.point_format, static_cast<std::uint16_t>(extra));
  if (!layout)
    throw Error(name + ": points of format " + std::to_string(form.point_format) +
                " have waveforms, which Lacuna cannot compress" + kWayOut);
  const std::uint64_t needed = laz::encoder_bytes(*layout) + laz::kMostChunkBytes;
  if (needed > scan.memory())
    throw Error(name + ": to compress points of " + std::to_string(layout->record_bytes()) + " bytes takes " +
                std::to_string(needed >> 20) + " MiB, more than the " + std::to_string(scan.memory() >> 20) +
                " MiB that the memory limit leaves for it" + kWayOut);
  return {.layout = *layout, .memory = scan.memory() / 2};  // the other half is for what reads the points
}

LasForm form_of(const LasInput& input, const PointsPlan& plan) {
  constexpr std::size_t kMostRecordBytes = 65535, kMostDescriptors = 341;  // 192 bytes each in 65535
  LasForm form = join_las(input.parts);
  if (form.record_bytes + bytes_of(plan.results) > kMostRecordBytes ||
      form.extra.size() + plan.results.size() > kMostDescriptors)
    throw Error(plan.name + ": " + std::to_string(form.extra.size()) + " extra values and " +
                std::to_string(form.record_bytes) +
                " bytes a point leave no room for the results in LAS; --points-format ply holds them all");
  return form;
}

class LasRecords final : public PointsWriter {
 public:
  template <class... Arguments>
  explicit LasRecords(Arguments&&... arguments) : writer_(std::forward<Arguments>(arguments)...) {}
  void put(std::span<const std::byte> rows) override { writer_.put(rows); }
  void finish() override { writer_.finish(); }

 private:
  LasWriter writer_;
};

class LasPointsForm final : public PointsForm {
 public:
  LasPointsForm(const PointsPlan& plan, bool is_compressed) : scan_(plan.scan), input_(examine(plan)) {
    survey(scan_, input_);
    form_ = form_of(input_, plan);
    extra_ = result_extra(plan.results, form_);
    if (is_compressed) compression_ = compression_of(form_, plan);
  }

  std::size_t row_bytes() const override { return form_.record_bytes; }
  std::unique_ptr<InputRows> open() const override { return std::make_unique<LasRows>(scan_, input_, form_); }
  std::unique_ptr<PointsWriter> writer(OutputFile& out, std::uint64_t, PointsPart part) const override {
    std::optional<LasOrigin> origin = input_.origin;
    if (origin) origin->has_counts = form_.is_as_it_was && part == PointsPart::kAll;
    return std::make_unique<LasRecords>(out, form_, extra_, std::move(origin), input_.parts.crs,
                                        compression_);
  }

 private:
  const FileScan& scan_;
  LasInput input_;
  LasForm form_;
  std::vector<LasExtraBytes> extra_;
  std::optional<LasCompression> compression_;
};

PointsPlan annotated_plan(const FileScan& scan, const OutputConfig& config, std::string name) {
  return {.scan = scan,
          .config = config,
          .results = result_columns(scan, config),
          .keeps_earlier = false,
          .name = std::move(name)};
}

void write_points(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                  bool is_compressed, OutputFile& out) {
  const PointsPlan plan = annotated_plan(scan, config, out.path().string());
  write_annotated(detection, LasPointsForm(plan, is_compressed), plan.results, out);
}

}  // namespace

FileMark points_las_mark() {
  return {kLasSoftware, kLasSoftwareAt};
}

std::unique_ptr<PointsForm> las_form(const PointsPlan& plan) {
  return std::make_unique<LasPointsForm>(plan, false);
}

std::unique_ptr<PointsForm> laz_form(const PointsPlan& plan) {
  return std::make_unique<LasPointsForm>(plan, true);
}

void check_las_form(const PointsPlan& plan) {
  form_of(examine(plan), plan);
}

void check_laz_form(const PointsPlan& plan) {
  compression_of(form_of(examine(plan), plan), plan);
}

void check_points_las(const FileScan& scan, const OutputConfig& config) {
  check_las_form(annotated_plan(scan, config, "points.las"));
}

void check_points_laz(const FileScan& scan, const OutputConfig& config) {
  check_laz_form(annotated_plan(scan, config, "points.laz"));
}

std::uint64_t las_row_bytes(const FileScan& scan, const OutputConfig& config) {
  const PointsPlan plan = annotated_plan(scan, config, points_file(scan, config));
  return form_of(examine(plan), plan).record_bytes + bytes_of(plan.results);
}

std::uint64_t laz_row_bytes(const FileScan& scan, const OutputConfig& config) {
  return las_row_bytes(scan, config) / 2;
}

void write_points_las(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out) {
  write_points(detection, scan, config, false, out);
}

void write_points_laz(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out) {
  write_points(detection, scan, config, true, out);
}

}  // namespace lacuna::io
