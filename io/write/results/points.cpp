// SPDX-License-Identifier: Apache-2.0
// The annotated scan: every row of the input in order, all of its columns, then the results.
//
// With points_format `input`, each file of the scan has one of the same name in the folder `points`. LAS, LAZ
// and PLY stay what they are, and text becomes CSV. LAS and LAZ files keep their header, records, scale and
// extra bytes. Files of other formats become PLY. So does LAS with a pose, since its scale may not hold the
// moved coordinates. The ending of each name follows the format.
//
// Else all files are joined to one, points.ply or points.csv, by the names of columns.
//
// A column of the input with the name of a result is left out, as an earlier run wrote it. PLY and CSV name
// results scalar_probability, scalar_angle and so on, as CloudCompare shows them. In PLY, `quality` is the
// probability for MeshLab, unless the input has a `quality`. Each file is read once more.

#include "engine/run/error.hpp"
#include "io/read/las/las_points.hpp"
#include "io/read/ply/ply.hpp"
#include "io/write/results/points_form.hpp"
#include "io/write/results/results.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPointsFolder = "points";  // in the output folder

struct FileFormat {
  std::string_view extension;
  std::unique_ptr<PointsForm> (*form)(const PointsPlan& plan);
};

constexpr FileFormat kPly{".ply", ply_form}, kCsv{".csv", csv_form}, kLas{".las", las_form},
    kLaz{".laz", las_form};

// A file of the annotated scan.
struct PointsFile {
  std::string name;
  const FileFormat* format;
  IndexRange files;  // of the scan
};

const FileFormat* own_format(const ScanFiles& scan, std::size_t file) {
  const std::optional<Format> format = scan.files()[file].format;
  const bool has_pose = scan.files()[file].pose.has_value();
  if (format == Format::kText) return &kCsv;
  if (format == Format::kLas && !has_pose) return is_compressed_las(scan.files()[file].name) ? &kLaz : &kLas;
  return &kPly;
}

bool is_in_folder(const OutputConfig& config) {
  return config.points_format == PointsFormat::kInput;
}

// Returns "points.ply", "points.csv", or "points/".
std::string points_name(const OutputConfig& config) {
  if (is_in_folder(config)) return std::string(kPointsFolder) + "/";
  return config.points_format == PointsFormat::kCsv ? "points.csv" : "points.ply";
}

// Throws `Error` if two files would have the same name.
std::vector<PointsFile> points_files(const ScanFiles& scan, const OutputConfig& config) {
  if (!is_in_folder(config)) {
    const bool is_csv = config.points_format == PointsFormat::kCsv;
    return {{points_name(config), is_csv ? &kCsv : &kPly, {0, scan.files().size()}}};
  }
  std::vector<PointsFile> files;
  std::map<std::string, std::size_t> inputs;  // by the name of what is written
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    const FileFormat* const format = own_format(scan, i);
    std::string name = scan.files()[i].name.stem().string();
    name += format->extension;
    if (const auto [known, is_new] = inputs.emplace(name, i); !is_new)
      throw Error(scan.files()[i].name.string() + ": its results and those of " +
                  scan.files()[known->second].name.string() + " would both be " + kPointsFolder + "/" + name +
                  "; rename one, or --points-format ply writes one file for all");
    files.push_back({std::move(name), format, {i, i + 1}});
  }
  return files;
}

std::vector<PointsFile> wanted_files(const ScanFiles& scan, const FilesConfig& config) {
  return config.results.points ? points_files(scan, config.output) : std::vector<PointsFile>();
}

bool has_own_quality(const RowLayout& layout) {
  for (std::size_t i = 0; i < layout.properties.size(); ++i) {
    if (layout.properties[i].name == kQuality && !is_earlier_quality(layout, i)) return true;
  }
  return false;
}

// The results include the quality of MeshLab in PLY, unless the input has its own.
std::vector<ResultColumn> results_of(const ScanFiles& scan, const OutputConfig& config,
                                     const PointsFile& file) {
  std::vector<ResultColumn> results = result_columns(scan, config);
  const auto files = std::span(scan.files()).subspan(file.files.first, file.files.last - file.files.first);
  const auto has_quality = [](const ScanFile& input) { return has_own_quality(input.layout); };
  if (file.format != &kPly || std::ranges::any_of(files, has_quality)) return results;
  const auto loop = std::find_if(results.begin(), results.end(),
                                 [](const auto& result) { return result.name == kBeforeQuality; });
  results.insert(loop + 1, {std::string(kQuality), Scalar::kFloat32, results.front().offset});
  return results;
}

PointsPlan plan_of(const ScanFiles& scan, const OutputConfig& config, const PointsFile& file,
                   const LocalOffset& offset) {
  std::string name = is_in_folder(config) ? std::string(kPointsFolder) + "/" + file.name : file.name;
  return {.scan = scan,
          .config = config,
          .files = file.files,
          .results = results_of(scan, config, file),
          .offset = offset,
          .name = std::move(name)};
}

[[noreturn]] void fail_changed(const std::string& name) {
  throw Error(name + ": the input has changed during the run; it must stay as it is");
}

// One file that is being written: rows of the input, each with its results.
class AnnotatedFile {
 public:
  AnnotatedFile(const PointsPlan& plan, const FileFormat& format, std::unique_ptr<OutputFile> out,
                std::uint64_t rows)
      : results_(plan.results),
        out_(std::move(out)),
        form_(format.form(plan)),
        input_(form_->open()),
        writer_(form_->writer(*out_, rows)) {
    if (&format != &kCsv) missing_ = rows;
  }

  // Writes the next rows with these results. Returns their number; 0: the input has no more rows.
  std::size_t put(std::span<const PointResult> results) {
    constexpr std::size_t kRows = std::size_t{1} << 14;
    const std::size_t bytes = form_->row_bytes(), stride = bytes + bytes_of(results_);
    const std::size_t rows = input_->next(std::min(results.size(), kRows), stride, block_);
    if (rows == 0) return 0;
    copy_results(results.first(rows), results_, stride, block_.data() + bytes);
    if (missing_) {
      if (rows > *missing_) fail_changed(out_->path().string());
      *missing_ -= rows;
    }
    writer_->put_rows(block_);
    return rows;
  }

  void finish() {
    if (missing_.value_or(0) > 0 || input_->next(1, form_->row_bytes() + bytes_of(results_), block_) != 0)
      fail_changed(out_->path().string());
    writer_->finish();
    out_->close();
  }

 private:
  std::vector<ResultColumn> results_;
  std::unique_ptr<OutputFile> out_;
  std::unique_ptr<PointsForm> form_;
  std::unique_ptr<InputRows> input_;
  std::unique_ptr<RowsWriter> writer_;
  std::optional<std::uint64_t> missing_;  // rows that the file declares and that are not written yet
  std::vector<std::byte> block_;
};

}  // namespace

void check_points(const ScanFiles& scan, const FilesConfig& config) {
  for (const PointsFile& file : wanted_files(scan, config))
    file.format->form(plan_of(scan, config.output, file, {}));
}

void write_points(const ExplainedDetection& detection, const ScanFiles& scan, const FilesConfig& config,
                  const ResultFolder& folder) {
  const OutputConfig& output = config.output;
  const std::vector<PointsFile> files = wanted_files(scan, config);
  if (files.empty()) return;
  const LocalOffset offset = local_offset(detection, output);
  const std::vector<std::uint64_t> rows_of_files = rows_of(scan, detection.counts);
  std::unique_ptr<AnnotatedFile> open;
  std::size_t next = 0;
  const auto open_next = [&] {
    if (open) open->finish();
    if (next == files.size()) fail_changed((folder.path() / points_name(output)).string());
    const PointsFile& file = files[next++];
    const PointsPlan plan = plan_of(scan, output, file, offset);
    const std::uint64_t rows =
        files.size() == 1 ? detection.summary.counts.points : rows_of_files[file.files.first];
    open = std::make_unique<AnnotatedFile>(plan, *file.format, folder.open(plan.name), rows);
  };
  open_next();
  detection.for_each_result_block([&](PointId, std::span<const PointResult> results) {
    while (!results.empty()) {
      const std::size_t rows = open->put(results);
      if (rows == 0) open_next();
      results = results.subspan(rows);
    }
  });
  while (next < files.size()) open_next();
  open->finish();
}

}  // namespace lacuna::io
