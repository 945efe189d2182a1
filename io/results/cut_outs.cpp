// SPDX-License-Identifier: Apache-2.0
#include "io/results/cut_outs.hpp"

#include "engine/run/job.hpp"
#include "io/ply/ply_writer.hpp"
#include "io/results/box_tree.hpp"
#include "io/results/local_coordinates.hpp"
#include "io/results/points.hpp"
#include "io/results/points_form.hpp"
#include "io/results/row_lists.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "hole-";

FileMark mark_of(FileFormat format) {
  return format == FileFormat::kCsv ? FileMark(",lacuna_hole", FileMark::kInFirstLine) : FileMark(kPlyMark);
}

std::string name_of_cut_out(std::uint64_t loop, FileFormat format) {
  std::string name(kPrefix);
  name += std::to_string(loop);
  return name += extension_of(format);
}

struct CutOutName {
  std::uint64_t loop;
  FileFormat format;
};

std::optional<CutOutName> parse_name(const std::string& name) {
  if (!name.starts_with(kPrefix)) return std::nullopt;
  CutOutName parsed{};
  const char* const end = name.data() + name.size();
  if (std::from_chars(name.data() + kPrefix.size(), end, parsed.loop).ec != std::errc{}) return std::nullopt;
  for (const FileFormat format : {FileFormat::kPly, FileFormat::kCsv}) {
    parsed.format = format;
    if (name == name_of_cut_out(parsed.loop, format)) return parsed;
  }
  return std::nullopt;
}

// Calls visit(name, parsed) for each file with the name of a cut-out.
template <class Visit>
void for_each_name(const fs::path& folder, const Visit& visit) {
  for (const std::string& name : names_in(folder / kCutOutsFolder)) {
    if (const auto parsed = parse_name(name)) visit(name, *parsed);
  }
}

PointsPlan plan_of(const FileScan& scan, const OutputConfig& config, FileFormat format,
                   const LocalOffset& offset) {
  PointsPlan plan{.scan = scan,
                  .config = config,
                  .files = {0, scan.files().size()},
                  .results = {},
                  .offset = offset,
                  .name = {}};
  if (format == FileFormat::kCsv) plan.results.push_back({kCutOutColumn, Scalar::kUint32, 0});
  return plan;
}

Eigen::AlignedBox3d box_of(const Detection& detection, std::size_t loop, double margin) {
  Eigen::AlignedBox3d box;
  detection.for_each_loop_point(loop, [&](const LoopPoint& point) { box.extend(point.position); });
  if (box.isEmpty()) return box;
  return {box.min().array() - margin, box.max().array() + margin};
}

// Puts each row into the lists of the boxes that have it.
void collect(const JoinedForm& form, const BoxTree& boxes, RowLists& lists) {
  constexpr std::size_t kRows = std::size_t{1} << 14;
  const std::unique_ptr<JoinedRows> rows = form.open_joined();
  const std::size_t stride = form.row_bytes();
  std::vector<std::byte> block;
  std::vector<Eigen::Vector3d> positions;
  while (const std::size_t count = rows->next(kRows, stride, block)) {
    rows->positions(positions);
    for (std::size_t row = 0; row < count; ++row) {
      boxes.for_each_around(positions[row], [&](std::size_t box) {
        lists.append(box, std::span(block).subspan(row * stride, stride));
      });
    }
  }
}

// Writes the rows of a list, each with the id of the hole behind it where the format has that column.
void write_rows(const RowLists& lists, std::size_t list, std::size_t row_bytes, std::size_t result_bytes,
                std::uint32_t hole, RowsWriter& writer) {
  constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
  const std::size_t stride = row_bytes + result_bytes;
  std::vector<std::byte> block;
  std::size_t filled = 0;  // bytes of the last row
  const auto put = [&](std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const auto part = bytes.first(std::min(bytes.size(), row_bytes - filled));
      block.insert(block.end(), part.begin(), part.end());
      bytes = bytes.subspan(part.size());
      filled += part.size();
      if (filled < row_bytes) return;
      filled = 0;
      const auto* id = reinterpret_cast<const std::byte*>(&hole);
      block.insert(block.end(), id, id + result_bytes);
      if (block.size() + stride > kBlockBytes) {
        writer.put_rows(block);
        block.clear();
      }
    }
  };
  lists.read(list, put);
  writer.put_rows(block);
  writer.finish();
}

}  // namespace

void check_cut_outs(const FileScan& scan, const FilesConfig& config, const fs::path& folder,
                    Overwrite overwrite) {
  const bool is_wanted = config.output.cut_outs > 0;
  const FileFormat format = joined_format(scan, config.output);
  if (is_wanted) check_subfolder(folder / kCutOutsFolder);
  for_each_name(folder, [&](const std::string& name, const CutOutName& parsed) {
    const fs::path file = folder / kCutOutsFolder / name;
    const bool is_needed = is_wanted && parsed.format == format;
    if (is_needed || is_own_file(file, mark_of(parsed.format))) check_not_input(file, scan);
    if (is_needed) check_output(file, mark_of(format), overwrite);
  });
}

void write_cut_outs(const Detection& detection, const FileScan& scan, const FilesConfig& config,
                    const fs::path& folder, OutputSet& set, std::size_t most_holes) {
  const bool is_wanted = config.output.cut_outs > 0;
  const FileFormat format = joined_format(scan, config.output);
  const auto is_written = [&](const CutOutName& name) {
    return is_wanted && name.format == format && name.loop < detection.loops.size() &&
           detection.loops[name.loop].kind == LoopKind::kHole;
  };
  for_each_name(folder, [&](const std::string& name, const CutOutName& parsed) {
    if (!is_written(parsed)) set.drop_in(folder, kCutOutsFolder, name, mark_of(parsed.format));
  });
  if (!is_wanted) return;

  constexpr std::size_t kLeastBlock = 4096, kMostBlock = 65536;
  const std::uint64_t memory = Memory::share(config.run.memory_limit).lists;
  most_holes = std::clamp<std::uint64_t>(memory / (2 * kLeastBlock), 1, most_holes);
  const PointsPlan plan = plan_of(scan, config.output, format, local_offset(detection, config.output));
  const auto form = format == FileFormat::kCsv ? csv_form(plan) : ply_form(plan);
  for (std::size_t loop = 0; loop < detection.loops.size();) {
    std::vector<std::size_t> holes;
    for (; loop < detection.loops.size() && holes.size() < most_holes; ++loop) {
      if (detection.loops[loop].kind == LoopKind::kHole) holes.push_back(loop);
    }
    if (holes.empty()) break;
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const std::size_t hole : holes) boxes.push_back(box_of(detection, hole, config.output.cut_outs));
    const std::size_t block = std::clamp<std::uint64_t>(memory / 2 / holes.size(), kLeastBlock, kMostBlock);
    const bool has_scratch = !config.run.scratch.empty() && fs::is_directory(config.run.scratch);
    RowLists lists((has_scratch ? fs::path(config.run.scratch) : folder) /
                       (std::string(kTemporaryPrefix) + kCutOutsFolder + "-" + random_digits()),
                   holes.size(), block);
    collect(*form, BoxTree(std::move(boxes)), lists);
    for (std::size_t i = 0; i < holes.size(); ++i) {
      const auto out =
          set.open_in(folder, kCutOutsFolder, name_of_cut_out(holes[i], format), mark_of(format));
      const auto writer = form->writer(*out, lists.size(i) / form->row_bytes());
      write_rows(lists, i, form->row_bytes(), bytes_of(plan.results), static_cast<std::uint32_t>(holes[i]),
                 *writer);
      out->close_unsynced();
    }
  }
}

}  // namespace lacuna::io
