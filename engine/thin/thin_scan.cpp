#include "engine/thin/thin_scan.hpp"

#include "engine/run/error.hpp"
#include "engine/store/outbox.hpp"
#include "engine/store/sorted_runs.hpp"
#include "engine/thin/lattice.hpp"
#include "engine/thin/occupied_cells.hpp"

#include <algorithm>
#include <functional>
#include <sstream>
#include <vector>

namespace lacuna {
namespace {

constexpr std::size_t kBatches = 4;  // in flight

struct ById {
  bool operator()(const Representative& a, const Representative& b) const { return a.point.id < b.point.id; }
};

// A batch with the places of its points, by their numbers in the batch.
struct PlacedBatch {
  PointBatch batch;
  std::vector<std::uint32_t> finite;
  std::vector<LatticePlace> places;  // of the finite points
  Eigen::AlignedBox3d bounds;

  void place(const Lattice& lattice, double resolution);
};

void PlacedBatch::place(const Lattice& lattice, double resolution) {
  finite.clear();
  places.clear();
  bounds.setEmpty();
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const Eigen::Vector3d& p = batch.positions[i];
    if (!p.allFinite()) continue;
    bounds.extend(p);
    finite.push_back(static_cast<std::uint32_t>(i));
    places.push_back(lattice.place_of(p));
    if (places.back().cell.allFinite()) continue;
    std::ostringstream message;
    message << "point " << value(batch.id(i)) << " at " << p.transpose()
            << " is too far away for a resolution of " << resolution << ": a larger one is needed";
    throw Error(message.str());
  }
}

// Streams the scan with the places of its points. visit(batch): in the order of the scan.
using Visit = std::function<void(const PlacedBatch&)>;
void for_each_batch(PointSource& scan, double resolution, Job& job, Phase& phase, const Visit& visit) {
  const Lattice lattice(resolution);
  std::vector<PlacedBatch> batches(kBatches);
  scan.rewind();
  job.arena.pipeline([&](std::size_t slot) { return scan.next(batches[slot].batch); },
                     [&](std::size_t slot) { batches[slot].place(lattice, resolution); },
                     [&](std::size_t slot) {
                       visit(batches[slot]);
                       phase.advance(batches[slot].batch.size());
                     },
                     kBatches);
}

// visit(place, number in the batch) for each finite point whose cell belongs to the share.
template <class VisitPoint>
void for_each_in_share(const PlacedBatch& batch, const OccupiedCells& cells, VisitPoint&& visit) {
  constexpr std::size_t kAhead = 16;
  for (std::size_t i = 0; i < batch.places.size(); ++i) {
    if (i + kAhead < batch.places.size()) cells.prefetch(batch.places[i + kAhead]);
    if (cells.share().contains(batch.places[i].hash)) visit(batch.places[i], batch.finite[i]);
  }
}

// First pass, for one batch. Where memory ends, half of the cells are left to `later`.
void add_points(const PlacedBatch& batch, OccupiedCells& cells, std::vector<CellShare>& later) {
  for_each_in_share(batch, cells, [&](const LatticePlace& place, std::uint32_t) {
    while (cells.share().contains(place.hash) && !cells.add(place)) {
      later.push_back(cells.share().half(true));
      cells.halve();
    }
  });
}

OccupiedCell& added_cell(OccupiedCells& cells, const LatticePlace& place) {
  OccupiedCell* const cell = cells.find(place);
  if (cell == nullptr) fail_changed("a point lies where none was counted");
  return *cell;
}

class Thinner {
 public:
  Thinner(PointSource& scan, double resolution, Job& job)
      : scan_(scan),
        resolution_(resolution),
        job_(job),
        phase_(job, "thin", (job.config.output.points ? 3 : 2) * scan.expected_points().value_or(0)),
        thinned_{.representatives = Column<Representative>(job.file("representatives")),
                 .resolution = resolution,
                 .has_normals = scan.has_normals(),
                 .represented = {}},
        chosen_(job.file("chosen"), job.memory.spills) {}

  ThinnedScan run() {
    std::vector<CellShare> shares = {{}};
    for (bool is_first = true; !shares.empty(); is_first = false) {
      OccupiedCells cells(shares.back(), job_.memory.global);
      shares.pop_back();
      stream([&](const PlacedBatch& batch) {
        if (is_first) count(batch);
        add_points(batch, cells, shares);
      });
      choose(cells);
      if (job_.config.output.points) assign(cells);
    }
    store();
    return std::move(thinned_);
  }

 private:
  void stream(const Visit& visit) { for_each_batch(scan_, resolution_, job_, phase_, visit); }

  void count(const PlacedBatch& batch) {
    thinned_.points += batch.batch.size();
    thinned_.dropped += batch.batch.size() - batch.finite.size();
    thinned_.bounds.extend(batch.bounds);
  }

  // Second pass: the representatives of these cells.
  void choose(OccupiedCells& cells) {
    stream([&](const PlacedBatch& batch) {
      for_each_in_share(batch, cells, [&](const LatticePlace& place, std::uint32_t i) {
        const Eigen::Vector3d normal =
            thinned_.has_normals ? batch.batch.normals[i] : Eigen::Vector3d::Zero();
        offer(added_cell(cells, place), place, batch.batch.positions[i], normal, batch.batch.id(i));
      });
    });
    for (const OccupiedCell& cell : cells.all()) {
      const Eigen::Vector3d &p = cell.nearest, &n = cell.normal;
      chosen_.add({{p.x(), p.y(), p.z(), cell.id}, {n.x(), n.y(), n.z()}});
    }
  }

  // Third pass: which of them represents each point.
  void assign(OccupiedCells& cells) {
    if (!thinned_.represented)
      thinned_.represented.emplace(job_.file("represented"), thinned_.points / kRepresentedBlock + 1,
                                   job_.memory.spills / 8);
    Outbox<Represented> outbox(*thinned_.represented);
    stream([&](const PlacedBatch& batch) {
      for_each_in_share(batch, cells, [&](const LatticePlace& place, std::uint32_t i) {
        const PointId representative = added_cell(cells, place).id;
        outbox.add(static_cast<TileIndex>(value(representative) / kRepresentedBlock),
                   {representative, batch.batch.id(i)});
      });
    });
    outbox.send();
  }

  // The representatives of all cells, in ascending id.
  void store() {
    constexpr std::size_t kTogether = 4096;
    std::vector<Representative> together;
    chosen_.for_each([&](const Representative& representative) {
      together.push_back(representative);
      if (together.size() < kTogether) return;
      thinned_.representatives.append(together);
      together.clear();
    });
    thinned_.representatives.append(together);
  }

  PointSource& scan_;
  double resolution_;
  Job& job_;
  Phase phase_;
  ThinnedScan thinned_;
  SortedRuns<Representative, ById> chosen_;
};

class Representatives final : public PointSource {
 public:
  explicit Representatives(const ThinnedScan& thinned) : thinned_(thinned) {}

  void rewind() override { next_ = 0; }
  bool next(PointBatch& batch) override {
    constexpr std::uint64_t kTogether = 1 << 16;
    batch = {};
    const std::uint64_t rest = thinned_.representatives.size() - next_;
    for (const auto& [point, normal] : thinned_.representatives.read(next_, std::min(rest, kTogether))) {
      batch.ids.push_back(point.id);
      batch.positions.push_back(point.position());
      if (thinned_.has_normals) batch.normals.emplace_back(normal.x, normal.y, normal.z);
    }
    next_ += batch.size();
    return batch.size() > 0;
  }
  std::optional<std::uint64_t> expected_points() const override { return thinned_.representatives.size(); }
  bool has_normals() const override { return thinned_.has_normals; }

 private:
  const ThinnedScan& thinned_;
  std::uint64_t next_ = 0;
};

}  // namespace

ThinnedScan thin_scan(PointSource& scan, double resolution, Job& job) {
  return Thinner(scan, resolution, job).run();
}

std::unique_ptr<PointSource> read_representatives(const ThinnedScan& thinned) {
  return std::make_unique<Representatives>(thinned);
}

}  // namespace lacuna
