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
  Thinner(PointSource& scan, double edge, bool wants_represented, Job& job)
      : scan_(scan),
        lattice_(edge),
        job_(job),
        thinned_{.representatives = Column<Representative>(job.file("representatives")),
                 .edge = edge,
                 .has_normals = scan.has_normals(),
                 .represented = {}},
        wants_represented_(wants_represented),
        parts_(job.file("cells"), parts_for(scan.expected_points().value_or(0)), job.memory.spills / 2) {}

  ThinnedScan run() {
    part();
    if (wants_represented_)
      thinned_.represented.emplace(job_.file("represented"), thinned_.points / kRepresentedBlock + 1,
                                   job_.memory.spills / 8);
    std::vector<std::uint64_t> needs;
    for (std::size_t p = 0; p < parts_.lists(); ++p) needs.push_back(parts_.count(p) * 4 * sizeof(Representative));
    // The representatives of part p are written once those of all parts before it are.
    std::vector<std::vector<Representative>> waiting(parts_.lists());
    std::vector<std::uint8_t> is_done(parts_.lists());
    std::mutex mutex;
    std::size_t next = 0;
    job_.arena.for_each_within_budget(needs, job_.memory.global, [&](std::size_t p) {
      std::vector<Representative> of_part = representatives_of(p);
      const std::lock_guard lock(mutex);
      waiting[p] = std::move(of_part);
      is_done[p] = 1;
      for (; next < waiting.size() && is_done[next]; ++next) {
        thinned_.representatives.append(waiting[next]);
        std::vector<Representative>().swap(waiting[next]);
      }
    });
    return std::move(thinned_);
  }

 private:
  struct Slot {
    PointBatch batch;
    Eigen::AlignedBox3d bounds;
    std::uint64_t finite = 0;
    OccupiedCells cells{1};
    std::vector<std::vector<Representative>> parts;
  };

  // Sends the points of the scan to their parts. Unless each of them is wanted, a batch sends one for each of its
  // cells.
  void part() {
    Phase phase(job_, "thin", scan_.expected_points().value_or(0));
    std::vector<Slot> slots(kBatches);
    scan_.rewind();
    job_.arena.pipeline([&](std::size_t s) { return scan_.next(slots[s].batch); },
                        [&](std::size_t s) { send(slots[s]); },
                        [&](std::size_t s) {
                          const Slot& slot = slots[s];
                          thinned_.points += slot.batch.size();
                          thinned_.dropped += slot.batch.size() - slot.finite;
                          thinned_.bounds.extend(slot.bounds);
                          phase.advance(slot.batch.size());
                        },
                        kBatches);
  }

  void send(Slot& slot) {
    slot.bounds.setEmpty();
    slot.finite = 0;
    slot.cells.clear();
    slot.parts.resize(parts_.lists());
    const PointBatch& batch = slot.batch;
    const auto add = [&](const LatticePlace& place, const Representative& point) {
      slot.parts[place.hash % slot.parts.size()].push_back(point);
    };
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const Eigen::Vector3d p = batch.positions[i].array() + 0.0;  // -0 is 0
      if (!p.allFinite()) continue;
      ++slot.finite;
      slot.bounds.extend(p);
      Representative point{{p.x(), p.y(), p.z(), batch.id(i)}, {}};
      if (thinned_.has_normals) {
        const Eigen::Vector3d& n = batch.normals[i];
        point.normal = {n.x(), n.y(), n.z()};
      }
      const LatticePlace place = place_of(point.point);
      wants_represented_ ? add(place, point) : slot.cells.add(place, point);
    }
    for (const Representative& point : slot.cells.representatives()) add(place_of(point.point), point);
    for (std::size_t p = 0; p < slot.parts.size(); ++p) {
      parts_.append(p, slot.parts[p]);
      slot.parts[p].clear();
    }
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

  PointSource& scan_;
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

ThinnedScan thin_scan(PointSource& scan, double edge, bool wants_represented, Job& job) {
  return Thinner(scan, edge, wants_represented, job).run();
}

std::unique_ptr<PointSource> read_representatives(const ThinnedScan& thinned) {
  return std::make_unique<Representatives>(thinned);
}

}  // namespace lacuna
