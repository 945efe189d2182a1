// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/scan_files.hpp"

#include "engine/run/error.hpp"
#include "io/read/crs/crs.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/scan/row_filter.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <sstream>
#include <vector>

#include <Eigen/Geometry>
#include <spdlog/fmt/fmt.h>

namespace lacuna::io {
namespace {

class ArrayReader final : public ScanReader {
 public:
  explicit ArrayReader(const ScanArrays& arrays) : arrays_(arrays) {
    for (const ScanColumn& column : arrays.columns) {
      layout_.properties.push_back({column.name, column.type, layout_.stride});
      layout_.stride += size_of(column.type);
    }
  }

  std::string format() const override { return "arrays"; }
  const RowLayout& layout() const override { return layout_; }
  std::optional<std::uint64_t> expected_rows() const override { return arrays_.rows; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    batch.count = std::min<std::uint64_t>(max_rows, arrays_.rows - next_);
    batch.bytes.resize(batch.count * layout_.stride);
    for (std::size_t i = 0; i < arrays_.columns.size(); ++i) {
      const auto& [name, type, first, stride] = arrays_.columns[i];
      copy_column({first + static_cast<std::ptrdiff_t>(next_) * stride, stride, type},
                  column_of(batch, layout_.stride, layout_.properties[i]), batch.count);
    }
    next_ += batch.count;
    return batch.count > 0;
  }

 private:
  const ScanArrays& arrays_;
  RowLayout layout_;
  std::uint64_t next_ = 0;
};

}  // namespace

std::unique_ptr<ScanReader> read_arrays(const ScanArrays& arrays) {
  return std::make_unique<ArrayReader>(arrays);
}

namespace {

// The coordinate reference systems and units of length of the files of a scan.

// Takes the other unit where there is none, and notes where the two contradict each other.
void take_unit(ScanFile& file, std::string ScanFile::*of, const std::string& other) {
  std::string& unit = file.*of;
  if (unit.empty()) unit = other;
  if (other.empty() || other == unit || !file.contradiction.empty()) return;
  const bool is_flat = of == &ScanFile::unit;
  file.contradiction = std::string("its unit and its system contradict each other: ") +
                       (is_flat ? "lengths" : "heights") + " are in " + unit + " or in " + other + "; " +
                       unit + " holds, and " + (is_flat ? "--unit " : "--unit-z ") + other +
                       " states the other";
}

void complete_units(std::vector<ScanFile>& files) {
  for (ScanFile& file : files) {
    take_unit(file, &ScanFile::unit, file.other_unit);
    if (file.is_geographic) continue;
    take_unit(file, &ScanFile::unit, length_unit(file.crs));
    take_unit(file, &ScanFile::z_unit, vertical_unit(file.crs));
  }
}

// Returns the first text of a file that is not empty, if the others are the same. Empty if two differ.
template <class Same>
std::string common(const std::vector<ScanFile>& files, std::string ScanFile::*text, const Same& is_same) {
  std::string first;
  for (const ScanFile& file : files) {
    if ((file.*text).empty()) continue;
    if (first.empty()) first = file.*text;
    if (!is_same(file.*text, first)) return "";
  }
  return first;
}

CommonSystem common_system(const StatedCrs& stated, const std::vector<ScanFile>& files) {
  CommonSystem all{stated.crs.empty() ? common(files, &ScanFile::crs, is_same_crs) : stated.crs, stated.unit};
  if (!all.unit.empty()) return all;
  const auto has_crs = [](const ScanFile& file) { return !file.crs.empty(); };
  const auto has_unit = [](const ScanFile& file) { return !file.unit.empty(); };
  const bool differ = all.crs.empty() && std::ranges::any_of(files, has_crs);
  if (!differ || std::ranges::all_of(files, has_unit))
    all.unit = common(files, &ScanFile::unit, std::equal_to<>());
  return all;
}

// Returns whether z has another unit than the vertical part of the system says. A stated unit of x and y that
// is not the file's own is a word against its unit of z, too.
bool choose_z_factor(const InputConfig& config, const StatedCrs& stated, const std::string& common_unit,
                     ScanFile& file) {
  const std::string& flat = !stated.unit.empty() ? stated.unit : file.unit.empty() ? common_unit : file.unit;
  const std::string said = stated.crs.empty() ? file.z_unit : vertical_unit(stated.crs);
  if (!stated.unit_z.empty()) {
    file.z_unit = stated.unit_z;
  } else if (!stated.unit.empty() && stated.unit != file.unit) {
    file.z_unit.clear();
  }
  const bool is_other = said != file.z_unit;
  const auto metres = metres_of_unit(flat), metres_of_z = metres_of_unit(file.z_unit);
  if (config.unit_z != LengthUnit::kInput && !metres)
    throw Error(file.name.string() +
                ": the unit of x and y is not known, into which --unit-z brings z; --unit states it");
  if (flat == file.z_unit || !metres || !metres_of_z) file.z_unit.clear();
  file.z_factor = file.z_unit.empty() ? 1 : *metres_of_z / *metres;
  return is_other || file.z_factor != 1;
}

// Completes what each file states of its units, and chooses how z is brought into the unit of x and y. A
// system states the units that a file does not, or contradicts them. Returns what holds for all. Throws
// `Error` if z has a stated unit, and x and y have none.
CommonSystem choose_systems(const InputConfig& config, const StatedCrs& stated,
                            std::vector<ScanFile>& files) {
  complete_units(files);
  CommonSystem all = common_system(stated, files);
  bool is_any = false;
  for (ScanFile& file : files) is_any = choose_z_factor(config, stated, all.unit, file) || is_any;
  if (is_any) all.crs = without_vertical(all.crs);
  return all;
}

}  // namespace

ReadOptions read_options(const InputConfig& config, std::uint64_t memory) {
  return {.columns = config.columns, .memory = memory, .trust = config.trust};
}

ScanFiles::ScanFiles(std::vector<ScanInput> inputs, InputConfig config, std::uint64_t memory)
    : config_(std::move(config)), memory_(memory), stated_(read_stated_crs(config_)) {
  for (ScanInput& input : inputs) add_file(std::move(input));
  common_ = choose_systems(config_, stated_, files_);
  const auto is_text = [](const ScanFile& file) { return file.format == Format::kText; };
  if (!config_.columns.empty() && std::ranges::none_of(files_, is_text))
    throw UsageError("--columns: names columns of text, and no file of the scan is text");
}

void ScanFiles::add_file(ScanInput input) {
  ScanFile& file = files_.emplace_back(ScanFile{std::move(input)});
  if (!file.arrays) {
    file.state = file_state(file.name);
    file.format = format_of(file.name);
  }
  const auto reader = open_in_own_units(files_.size() - 1);
  const RowFilter filter(config_, file.name, *reader);
  file.layout = reader->layout();
  file.crs = reader->crs();
  file.other_crs = reader->other_crs();
  file.unit = reader->length_unit();
  file.other_unit = reader->other_unit();
  file.z_unit = reader->vertical_unit();
  file.notes = reader->notes();
  file.has_scanner_at_zero = !file.pose && reader->has_scanner_at_zero();
  const std::vector<ScannerPose> scanners = reader->scanners();
  if (!file.pose && scanners.size() == 1 && !scanners[0].source) file.scanner = scanners[0].place;
  file.expected_rows = reader->expected_rows();
  file.is_geographic = reader->is_geographic();
  const bool says_nothing = file.crs.empty() && file.unit.empty() && file.other_unit.empty();
  file.may_be_degrees = !file.is_geographic && says_nothing && look_like_degrees(*reader);
  reads_slowly_ = reads_slowly_ || reader->is_slow();
  has_normals_ = has_normals_ || has_vectors(file.layout, kNormalNames);
  has_scanners_ = has_scanners_ || !scanners.empty();
}

std::optional<std::uint64_t> ScanFiles::expected_points() const {
  std::uint64_t points = 0;
  for (const ScanFile& file : files_) {
    if (!file.expected_rows) return std::nullopt;
    points += *file.expected_rows;
  }
  return points;
}

std::size_t ScanFiles::batch_rows(std::size_t file) const {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 16;
  return std::clamp<std::uint64_t>(memory_ / 2 / files_[file].layout.stride, 1, kMost);
}

std::unique_ptr<ScanReader> ScanFiles::open(std::size_t file) const {
  auto reader = open_in_own_units(file);
  const double factor = files_[file].z_factor;
  return factor == 1 ? std::move(reader) : with_z_times(std::move(reader), factor);
}

std::unique_ptr<ScanReader> ScanFiles::open_in_own_units(std::size_t index) const {
  const ScanFile& file = files_[index];
  if (file.arrays) return read_arrays(*file.arrays);
  io::check_unchanged(file.name, file.state);
  auto reader = open_scan(*file.format, file.name, read_options(config_, memory_));
  return file.pose ? posed(std::move(reader), *file.pose) : std::move(reader);
}

void ScanFiles::check_unchanged() const {
  for (const ScanFile& file : files_) {
    if (!file.arrays) io::check_unchanged(file.name, file.state);
  }
}

std::vector<RowLayout> layouts_of(const ScanFiles& scan) {
  std::vector<RowLayout> layouts;
  for (const ScanFile& file : scan.files()) layouts.push_back(file.layout);
  return layouts;
}

std::vector<std::filesystem::path> names_of(const ScanFiles& scan) {
  std::vector<std::filesystem::path> names;
  for (const ScanFile& file : scan.files()) names.push_back(file.name);
  return names;
}

std::vector<std::uint64_t> estimated_rows(const ScanFiles& scan) {
  constexpr std::uint64_t kBytesOfLine = 24;
  std::vector<std::uint64_t> rows;
  for (const ScanFile& file : scan.files())
    rows.push_back(file.expected_rows.value_or(file.state.size / kBytesOfLine));
  return rows;
}

bool has_single_precision(const ScanFiles& scan) {
  return std::ranges::all_of(scan.files(), [](const ScanFile& file) {
    return std::ranges::all_of(
        kPositionNames, [&](const char* name) { return file.layout.find(name)->type == Scalar::kFloat32; });
  });
}

namespace {

std::filesystem::path full_name(const std::filesystem::path& file) {
  return std::filesystem::absolute(file).lexically_normal();
}

std::string pose_text(const ScanFile& file) {
  std::ostringstream pose;
  if (file.pose) pose << file.pose->matrix().format(Eigen::IOFormat(17, Eigen::DontAlignCols, " ", " "));
  return pose.str();
}

}  // namespace

std::vector<std::string> identity_of(const ScanFiles& scan) {
  std::vector<std::string> lines;
  if (std::ranges::any_of(scan.files(), [](const ScanFile& file) { return file.arrays != nullptr; }))
    return lines;
  for (const ScanFile& file : scan.files()) {
    const Digest sample = sample_digest(file.name, file.state);
    lines.push_back(fmt::format("{}, {} bytes, written at {} ns, sample {:x}{:x}{}",
                                full_name(file.name).string(), file.state.size, file.state.mtime, sample[0],
                                sample[1], file.pose ? ", pose " + pose_text(file) : ""));
  }
  FilesConfig config;
  config.input = scan.config();
  for (const Parameter& p : file_parameters(config)) {
    if (p.changes == Changes::kPoints) lines.push_back(std::string(p.key) + " = " + p.print());
  }
  if (const std::string& crs = scan.stated_crs().crs; !crs.empty())  // a file counts by its content
    lines.push_back(fmt::format("text of crs = {:x}", digest_of(crs)[0]));
  return lines;
}

std::vector<std::string> kept_names(const ScanFiles& scan) {
  std::vector<std::string> names;
  for (const ScanFile& file : scan.files())
    names.insert(names.end(), {file.name.string(), full_name(file.name).string(), pose_text(file)});
  return names;
}

std::vector<ScanInput> inputs_of(std::span<const std::string> names) {
  std::vector<ScanInput> inputs;
  if (names.size() % 3 != 0) fail_inconsistent("an input of a workspace has no name");
  for (; !names.empty(); names = names.subspan(3)) {
    const std::string& file = full_name(names[0]) == names[1] ? names[0] : names[1];
    inputs.emplace_back(file, names[2].empty() ? std::nullopt : std::optional(parse_pose(names[2])));
  }
  return inputs;
}

std::vector<std::size_t> repeated_files(const ScanFiles& scan) {
  std::set<FileIdentity> seen;
  std::vector<std::size_t> repeated;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    const ScanFile& file = scan.files()[i];
    if (!file.arrays && !seen.emplace(file.state.device, file.state.inode).second) repeated.push_back(i);
  }
  return repeated;
}

void check_not_input(const ResultFolder& folder, const ScanFiles& scan) {
  for (const std::filesystem::path& earlier : folder.earlier_files()) {
    const std::optional<FileIdentity> identity = find_identity(earlier);
    for (const ScanFile& file : scan.files()) {
      if (!file.arrays && identity == FileIdentity(file.state.device, file.state.inode))
        throw Error(file.name.string() +
                    ": is an input in the place of a result; another output folder is needed");
    }
  }
}

namespace {

// Whether all values of an axis are multiples of the step, as far as single precision shows it.
bool are_in_steps(std::span<const Eigen::Vector3d> positions, int axis, double step) {
  return std::ranges::all_of(positions, [&](const Eigen::Vector3d& position) {
    const double steps = position[axis] / step;
    return std::abs(steps - std::round(steps)) <= 6e-8 * std::abs(steps) + 1e-6;
  });
}

}  // namespace

bool look_like_degrees(std::span<const Eigen::Vector3d> positions) {
  constexpr std::size_t kFewest = 10;
  constexpr double kWidest = 3, kFarther = 10, kHigher = 100, kFourDecimals = 1e-4, kTwoDecimals = 1e-2;
  if (positions.size() < kFewest) return false;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : positions) box.extend(position);
  const Eigen::Array3d sizes = box.sizes(), most = box.min().array().abs().max(box.max().array().abs());
  const double widest = sizes.head<2>().maxCoeff();
  const bool are_in_range = most.head<2>().minCoeff() <= 90 && most.head<2>().maxCoeff() <= 360;
  const bool is_one_far = (most.head<2>() > (kFarther + 1) * sizes.head<2>()).any();
  if (!are_in_range || widest > kWidest || !is_one_far || sizes.z() < widest) return false;
  if (are_in_steps(positions, 0, kFourDecimals) || are_in_steps(positions, 1, kFourDecimals)) return false;
  return sizes.z() > kHigher * widest || are_in_steps(positions, 2, kTwoDecimals);
}

bool look_like_degrees(ScanReader& reader) {
  constexpr std::size_t kRows = 4096;
  RowBatch rows;
  std::vector<Eigen::Vector3d> positions;
  if (!reader.next(rows, kRows)) return false;
  load_vectors(rows, reader.layout(), kPositionNames, positions);
  std::erase_if(positions, [](const Eigen::Vector3d& position) { return !position.allFinite(); });
  return look_like_degrees(positions);
}

namespace {

constexpr const char* kGeocentricCode = "EPSG:4978";

// Projected systems have such places, too, but no such heights.
bool is_on_earth(const Eigen::Vector3d& place) {
  constexpr double kLeast = 6'330'000, kMost = 6'400'000, kLeastHeight = 20'000;
  return place.norm() > kLeast && place.norm() < kMost && std::abs(place.z()) > kLeastHeight;
}

}  // namespace

std::optional<Eigen::Vector3d> find_place(const ScanFiles& scan, std::size_t file) {
  constexpr std::size_t kRows = 1000;
  const auto reader = scan.open(file);
  RowBatch rows;
  std::vector<Eigen::Vector3d> positions;
  if (reader->next(rows, kRows)) load_vectors(rows, reader->layout(), kPositionNames, positions);
  const auto found = std::ranges::find_if(positions, [](const Eigen::Vector3d& position) {
    return position.allFinite() && position != Eigen::Vector3d::Zero();
  });
  return found == positions.end() ? std::nullopt : std::optional(*found);
}

std::string utm_zone(double longitude, double latitude) {
  const int zone = std::clamp(static_cast<int>(std::floor((longitude + 180) / 6)) + 1, 1, 60);
  return "EPSG:" + std::to_string((latitude < 0 ? 32700 : 32600) + zone);
}

void require_plan(const ScanFiles& scan, const std::string& option) {
  const std::string& stated = scan.stated_crs().crs;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    const std::string& crs = stated.empty() ? scan.files()[i].crs : stated;
    if (i > 0 && (!stated.empty() || crs == scan.files()[i - 1].crs)) continue;
    const bool is_guess = crs.empty();
    const bool may_be_metres = scan.files()[i].unit.empty() || scan.files()[i].unit == "m";
    if (is_guess && (!may_be_metres || !scan.stated_crs().unit.empty())) continue;
    if (!is_guess && !facts_of(crs).is_geocentric) continue;
    const auto place = find_place(scan, i);
    if (is_guess && !(place && is_on_earth(*place))) continue;
    std::optional<std::vector<Eigen::Vector3d>> degrees;
    if (place) degrees = to_degrees(is_guess ? kGeocentricCode : crs, {*place}, scan.files()[i].name);
    const std::string zone = degrees ? utm_zone(degrees->front().x(), degrees->front().y()) : "EPSG:N";
    throw Error(scan.files()[i].name.string() + ": " +
                (is_guess ? "its places are geocentric, as of EPSG:4978"
                          : name_of_crs(facts_of(crs).known_text) + " is geocentric") +
                ", and " + option + " needs a plan; `pdal translate IN OUT reprojection " +
                (is_guess ? "--filters.reprojection.in_srs=EPSG:4978 " : "") +
                "--filters.reprojection.out_srs=" + zone + "` projects it" +
                (is_guess ? "; if they are not, --unit m or --crs says so" : ""));
  }
}

}  // namespace lacuna::io
