// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/read/las/las_header.hpp"
#include "io/read/las/las_points.hpp"
#include "io/read/las/las_writer.hpp"
#include "io/read/laz/laz.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/write/results/points_form.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

namespace lacuna::io {
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
