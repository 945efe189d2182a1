#include "engine/thin/thin_scan.hpp"

#include "engine/run/error.hpp"
#include "engine/store/outbox.hpp"
#include "engine/thin/lattice.hpp"

#include <algorithm>
#include <mutex>
#include <sstream>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

constexpr std::size_t kBatches = 4;  // in flight

// Parts of the scan by the hash of the cell. Their number depends on the scan alone, and so does the order of
// the representatives.
std::size_t parts_for(std::uint64_t points) {
  constexpr std::uint64_t kPointsOfPart = 100'000, kMostParts = 1 << 14, kWhereUnknown = 256;
  return points == 0 ? kWhereUnknown : std::clamp<std::uint64_t>(points / kPointsOfPart, 1, kMostParts);
}

struct ById {
  bool operator()(const Representative& a, const Representative& b) const { return a.point.id < b.point.id; }
};

class Thinner {
 public:
  Thinner(double edge, std::uint64_t expected_points, bool has_normals, bool wants_represented, Job& job)
      : lattice_(edge),
        job_(job),
        thinned_{.representatives = Column<Representative>(job.file("representatives")),
                 .edge = edge,
                 .has_normals = has_normals,
                 .represented = {}},
        wants_represented_(wants_represented),
        parts_(job.file("cells"), parts_for(expected_points), job.memory.spills / 2) {}

  // Points on their way to their parts. One thread at a time has a batch.
  struct Batch {
    Eigen::AlignedBox3d bounds;
    std::uint64_t points = 0, finite = 0;
    OccupiedCells cells{1};
    std::vector<std::vector<Representative>> parts;
  };

  void start(Batch& batch) const {
    batch.bounds.setEmpty();
    batch.points = batch.finite = 0;
    batch.cells.clear();
    batch.parts.resize(parts_.lists());
  }

  void add(const Eigen::Vector3d& position, PointId id, const Eigen::Vector3d& normal, Batch& batch) const {
    ++batch.points;
    if (!position.allFinite()) return;
    ++batch.finite;
    const Eigen::Vector3d p = position.array() + 0.0;  // -0 is 0
    batch.bounds.extend(p);
    const Representative point{{p.x(), p.y(), p.z(), id}, {normal.x(), normal.y(), normal.z()}};
    const LatticePlace place = place_of(point.point);
    wants_represented_ ? send(place, point, batch) : batch.cells.add(place, point);
  }

  // Unless each point is wanted, a batch sends one for each of its cells. From any thread.
  void send(Batch& batch) {
    for (const Representative& point : batch.cells.representatives())
      send(place_of(point.point), point, batch);
    for (std::size_t p = 0; p < batch.parts.size(); ++p) {
      parts_.append(p, batch.parts[p]);
      batch.parts[p].clear();
    }
  }

  // By one thread at a time.
  void count(const Batch& batch) {
    thinned_.points += batch.points;
    thinned_.dropped += batch.points - batch.finite;
    thinned_.bounds.extend(batch.bounds);
  }

  // All points are sent.
  ThinnedScan finish() {
    if (wants_represented_)
      thinned_.represented.emplace(job_.file("represented"), thinned_.points / kRepresentedBlock + 1,
                                   job_.memory.spills / 8);
    std::vector<std::uint64_t> needs;
    for (std::size_t p = 0; p < parts_.lists(); ++p) needs.push_back(parts_.count(p) * kBytesPerPoint);
    // The representatives of a part are written once those of all parts before it are.
    std::vector<std::vector<Representative>> waiting(parts_.lists());
    std::vector<std::uint8_t> is_done(parts_.lists());
    std::size_t next = 0;
    std::mutex mutex;
    job_.arena.for_each_within_budget(needs, job_.memory.global, [&](std::size_t p) {
      std::vector<Representative> of_part = representatives_of(p);
      const std::lock_guard lock(mutex);
      waiting[p] = std::move(of_part);
      is_done[p] = 1;
      for (; next < waiting.size() && is_done[next]; ++next) {
        thinned_.representatives->append(waiting[next]);
        std::vector<Representative>().swap(waiting[next]);
      }
    });
    thinned_.left = thinned_.representatives->size();
    return std::move(thinned_);
  }

  static constexpr std::uint64_t kBytesPerPoint = 256;  // of a part or batch, with its cells

 private:
  static void send(const LatticePlace& place, const Representative& point, Batch& batch) {
    batch.parts[place.hash % batch.parts.size()].push_back(point);
  }

  LatticePlace place_of(const StoredPoint& point) const {
    const LatticePlace place = lattice_.place_of(point.position());
    if (place.cell.allFinite()) return place;
    std::ostringstream message;
    message << "point " << value(point.id) << " at " << point.position().transpose()
            << " is too far away for a resolution of " << thinned_.edge << ": a larger one is needed";
    throw Error(message.str());
  }

  // In ascending id.
  std::vector<Representative> representatives_of(std::size_t part) {
    const std::vector<Representative> points = parts_.read(part);
    parts_.drop(part);
    OccupiedCells cells(points.size());
    for (const Representative& point : points) cells.add(place_of(point.point), point);
    if (wants_represented_) {
      Outbox<Represented> outbox(*thinned_.represented);
      for (const Representative& point : points) {
        const PointId representative = cells.at(place_of(point.point)).point.id;
        outbox.add(static_cast<TileIndex>(value(representative) / kRepresentedBlock),
                   {representative, point.point.id});
      }
      outbox.send();
    }
    std::vector<Representative> all(cells.representatives().begin(), cells.representatives().end());
    std::sort(all.begin(), all.end(), ById());
    return all;
  }

  Lattice lattice_;
  Job& job_;
  ThinnedScan thinned_;
  bool wants_represented_;
  AppendLists<Representative> parts_;
};

class Representatives final : public PointSource {
 public:
  explicit Representatives(const ThinnedScan& thinned) : thinned_(thinned) {}

  void rewind() override { next_ = 0; }
  bool next(PointBatch& batch) override {
    constexpr std::uint64_t kTogether = 1 << 16;
    batch = {};
    const std::uint64_t rest = thinned_.left - next_;
    for (const auto& [point, normal] : thinned_.representatives->read(next_, std::min(rest, kTogether))) {
      batch.ids.push_back(point.id);
      batch.positions.push_back(point.position());
      if (thinned_.has_normals) batch.normals.emplace_back(normal.x, normal.y, normal.z);
    }
    next_ += batch.size();
    return batch.size() > 0;
  }
  std::optional<std::uint64_t> expected_points() const override { return thinned_.left; }
  bool has_normals() const override { return thinned_.has_normals; }

 private:
  const ThinnedScan& thinned_;
  std::uint64_t next_ = 0;
};

}  // namespace

ThinnedScan thin_scan(PointSource& scan, double edge, Job& job) {
  const std::uint64_t expected = scan.expected_points().value_or(0);
  Phase phase(job, "thin", expected);
  Thinner thinner(edge, expected, scan.has_normals(), job.config.output.points, job);
  struct Slot {
    PointBatch points;
    Thinner::Batch batch;
  };
  std::vector<Slot> slots(kBatches);
  const Eigen::Vector3d no_normal = Eigen::Vector3d::Zero();
  scan.rewind();
  job.arena.pipeline([&](std::size_t s) { return scan.next(slots[s].points); },
                     [&](std::size_t s) {
                       auto& [points, batch] = slots[s];
                       thinner.start(batch);
                       for (std::size_t i = 0; i < points.size(); ++i)
                         thinner.add(points.positions[i], points.id(i),
                                     points.normals.empty() ? no_normal : points.normals[i], batch);
                       thinner.send(batch);
                     },
                     [&](std::size_t s) {
                       thinner.count(slots[s].batch);
                       phase.advance(slots[s].points.size());
                     },
                     kBatches);
  return thinner.finish();
}

ThinnedScan thin_store(const TileStore& store, double edge, Job& job) {
  const Tiling& tiling = store.tiling();
  Thinner thinner(edge, tiling.points(), store.has_normals(), false, job);
  std::vector<std::uint64_t> needs;
  for (const Tile& tile : tiling.tiles) needs.push_back(tile.points * Thinner::kBytesPerPoint);
  std::mutex mutex;
  const Eigen::Vector3d no_normal = Eigen::Vector3d::Zero();
  job.arena.for_each_within_budget(needs, job.memory.tiles, [&](std::size_t t) {
    Thinner::Batch batch{.cells = OccupiedCells(tiling.tiles[t].points)};
    thinner.start(batch);
    const std::vector<Eigen::Vector3d> normals = store.normals(static_cast<TileIndex>(t));
    std::size_t i = 0;
    store.for_each_point(static_cast<TileIndex>(t), [&](const StoredPoint& p) {
      thinner.add(p.position(), p.id, normals.empty() ? no_normal : normals[i], batch);
      ++i;
    });
    thinner.send(batch);
    const std::lock_guard lock(mutex);
    thinner.count(batch);
  });
  return thinner.finish();
}

std::unique_ptr<PointSource> read_representatives(const ThinnedScan& thinned) {
  return std::make_unique<Representatives>(thinned);
}

}  // namespace lacuna
