// SPDX-License-Identifier: Apache-2.0
#include "io/read/pcd/pcd_reader.hpp"

#include "io/read/files/number.hpp"
#include "io/read/pcd/pcd_fields.hpp"
#include "io/read/pcd/pcd_rows.hpp"

#include <algorithm>

namespace lacuna::io {
namespace {

class PcdReader final : public ScanReader {
 public:
  explicit PcdReader(const std::filesystem::path& file)
      : rows_(file), layout_(pcd_layout(rows_.in(), rows_.header())) {}

  std::string format() const override { return std::string("PCD, ") + pcd_name(rows_.header().encoding); }
  const RowLayout& layout() const override { return layout_; }
  std::vector<Eigen::Vector3d> no_return_places() const override {
    std::vector<Eigen::Vector3d> places{Eigen::Vector3d::Zero()};
    if (const auto scanner = rows_.header().scanner()) places.push_back(*scanner);
    return places;
  }
  std::vector<ScannerPose> scanners() const override {
    const auto place = rows_.header().scanner();
    return place ? std::vector{ScannerPose{.place = *place}} : std::vector<ScannerPose>{};
  }
  bool has_scanner_at_zero() const override { return !rows_.header().scanner(); }
  std::optional<Pose> viewpoint() const override { return rows_.header().viewpoint; }
  std::optional<std::uint64_t> expected_rows() const override { return rows_.header().rows; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    batch.count = rows_.next(raw_, max_rows);
    batch.bytes.resize(batch.count * layout_.stride);
    if (batch.count > 0) convert_pcd_rows(rows_.header(), raw_.data(), layout_, batch);
    return batch.count > 0;
  }

 private:
  PcdRows rows_;
  RowLayout layout_;
  std::vector<std::byte> raw_;  // rows as the header describes them
};

}  // namespace

bool looks_like_pcd(const FileStart& start) {
  if (start.first_bytes.starts_with("# .PCD")) return true;
  std::string_view rest = start.first_bytes;
  while (!rest.empty()) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    std::string_view word;
    if (!next_field(line, ' ', word) || word.starts_with('#')) continue;
    return word == "VERSION";
  }
  return false;
}

std::unique_ptr<ScanReader> open_pcd(const std::filesystem::path& file, const ReadOptions&) {
  return std::make_unique<PcdReader>(file);
}

}  // namespace lacuna::io
