#include "engine/lacuna.hpp"

#include "engine/store/temporary_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

namespace lacuna {
namespace {

using Vectors = std::span<const Eigen::Vector3d>;

constexpr std::size_t kBatch = 1 << 16;

// Points in memory as a source: batches are copies.
class PointsInMemory final : public PointSource {
 public:
  PointsInMemory(Vectors points, Vectors normals) : points_(points), normals_(normals) {}

  void rewind() override { next_ = 0; }

  bool next(PointBatch& batch) override {
    const std::size_t count = std::min(kBatch, points_.size() - next_);
    const auto copy = [&](Vectors all) {
      const Vectors part = all.empty() ? all : all.subspan(next_, count);
      return std::vector(part.begin(), part.end());
    };
    batch = {PointId{next_}, {}, copy(points_), copy(normals_)};
    next_ += count;
    return count > 0;
  }

  std::optional<std::uint64_t> expected_points() const override { return points_.size(); }
  bool has_normals() const override { return !normals_.empty(); }

 private:
  Vectors points_, normals_;
  std::size_t next_ = 0;
};

}  // namespace

Holes find_holes(PointSource& scan, const Config& config) {
  namespace fs = std::filesystem;
  const fs::path parent =
      config.run.workspace.empty() ? fs::temp_directory_path() : fs::path(config.run.workspace);
  const TemporaryFolder workspace(parent, "lacuna-");
  NoProgress silence;
  const std::unique_ptr<Detection> detection = detect(scan, config, workspace.path(), silence);

  Holes holes;
  holes.summary = detection->summary();
  holes.loops.reserve(detection->loops().size());
  for (std::size_t i = 0; i < detection->loops().size(); ++i) holes.loops.push_back(detection->read_loop(i));
  if (config.output.points) {
    holes.points.reserve(holes.summary.counts.points);
    detection->for_each_result_block([&](PointId, std::span<const PointResult> block) {
      holes.points.insert(holes.points.end(), block.begin(), block.end());
    });
  }
  return holes;
}

Holes find_holes(Vectors points, Vectors normals, const Config& config) {
  if (normals.size() != points.size()) {
    throw Error(std::to_string(normals.size()) + " normals for " + std::to_string(points.size()) +
                " points; allowed: one for each point");
  }
  PointsInMemory scan(points, normals);
  return find_holes(scan, config);
}

Holes find_holes(Vectors points, const Config& config) {
  PointsInMemory scan(points, {});
  return find_holes(scan, config);
}

}  // namespace lacuna
