// SPDX-License-Identifier: Apache-2.0
#include "tests/support/detected.hpp"

#include "engine/criteria/criteria.hpp"
#include "engine/results/collect.hpp"
#include "engine/store/digest.hpp"

#include <algorithm>
#include <utility>

namespace lacuna {

bool MemoryScan::next(PointBatch& batch) {
  const std::size_t end = std::min(next_ + batch_, end_);
  const auto part = [&](const std::vector<Eigen::Vector3d>& all) {
    if (all.empty()) return std::vector<Eigen::Vector3d>{};
    return std::vector(all.begin() + static_cast<std::ptrdiff_t>(next_),
                       all.begin() + static_cast<std::ptrdiff_t>(end));
  };
  batch = {PointId{value(id_) + next_ - first_}, {}, part(cloud_.positions), part(cloud_.normals)};
  next_ = end;
  return batch.size() > 0;
}

SourceParts MemoryScan::parts() const {
  const auto text_of = [](const std::vector<Eigen::Vector3d>& vectors) {
    return std::to_string(digest_of(std::as_bytes(std::span(vectors)))[0]);
  };
  SourceParts parts{.identity = {text_of(cloud_.positions), text_of(cloud_.normals)}};
  for (std::size_t part = 0; part < kParts; ++part)
    parts.points.push_back(first_of(part + 1) - first_of(part));
  return parts;
}

void MemoryScan::rewind_to(const IndexRange& parts, PointId first) {
  next_ = first_ = first_of(parts.first);
  end_ = first_of(parts.last);
  id_ = first;
}

Cloud read_points(PointSource& source) {
  Cloud all;
  PointBatch batch;
  while (source.next(batch)) {
    REQUIRE((batch.ids.empty() && value(batch.first) == all.size()));
    all.positions.insert(all.positions.end(), batch.positions.begin(), batch.positions.end());
    all.normals.insert(all.normals.end(), batch.normals.begin(), batch.normals.end());
  }
  CHECK(batch.size() == 0);
  CHECK(value(batch.first) == all.size());
  return all;
}

namespace {

template <class T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put(std::string& bytes, const Eigen::Vector3d& v) {
  for (int axis = 0; axis < 3; ++axis) put(bytes, v[axis]);
}

}  // namespace

std::vector<std::vector<PointId>> Detected::loop_ids() const {
  std::vector<std::vector<PointId>> ids;
  for (const ReportedLoop& loop : loops) {
    ids.emplace_back();
    for (const LoopPoint& p : loop.points) ids.back().push_back(p.id);
  }
  return ids;
}

std::string Detected::bytes() const {
  std::string bytes;
  for (const PointResult& p : points) {
    put(bytes, p.probability);
    for (std::size_t i = 0; i < criteria().size(); ++i) put(bytes, p.criteria[i]);
    for (int axis = 0; axis < 3; ++axis) put(bytes, p.normal[axis]);
    put(bytes, p.boundary);
    put(bytes, p.coherent);
    put(bytes, p.loop);
  }
  for (const BoundaryPoint& p : boundary) {
    put(bytes, p.id);
    put(bytes, p.position());
    put(bytes, p.probability);
    put(bytes, p.loop);
  }
  for (const ReportedLoop& loop : loops) {
    const LoopMeasures& m = loop.measures;
    for (const double value :
         {m.perimeter, m.area, m.diameter, m.planarity, m.mean_probability, m.track.confidence,
          m.track.evidence.prominence, m.track.first_scale, m.track.last_scale})
      put(bytes, value);
    put(bytes, m.kind);
    put(bytes, m.points);
    put(bytes, m.centroid);
    put(bytes, m.normal);
    put(bytes, m.tiles);
    put(bytes, m.parent);
    for (const LoopPoint& p : loop.points) {
      put(bytes, p.id);
      put(bytes, p.position());
      put(bytes, p.probability);
    }
  }
  const Counts& c = summary.counts;
  for (const std::uint64_t count :
       {c.points, c.dropped, c.thinned_out, c.duplicates, c.candidates, c.coherent, c.boundary_points,
        c.boundary_edges, c.components, c.raw_loops, c.undefined_normals}) {
    put(bytes, count);
  }
  put(bytes, summary.resolution);
  put(bytes, summary.mean_neighbours);
  put(bytes, summary.mean_edge_length);
  put(bytes, summary.median_distance);
  put(bytes, summary.surface_area);
  put(bytes, summary.strays.points);
  put(bytes, summary.strays.example);
  put(bytes, summary.strays.rest.min());
  put(bytes, summary.strays.rest.max());
  put(bytes, summary.e);
  return bytes;
}

Detected run_engine(const Cloud& cloud, Config config) {
  MemoryScan scan(cloud);
  return run_engine(scan, std::move(config));
}

Detected run_engine(PointSource& scan, Config config) {
  NoProgress quiet;
  return run_engine(scan, std::move(config), quiet);
}

Detected run_engine(PointSource& scan, Config config, Progress& progress) {
  config.results.points = true;
  const ScratchFolder temporary;
  const std::unique_ptr<Detection> detection = detect(scan, config, temporary.path(), progress);
  Detected detected{.summary = detection->summary};
  detection->for_each_result_block([&](PointId first, std::span<const PointResult> block) {
    REQUIRE(value(first) == detected.points.size());
    REQUIRE(block.size() <= kResultBlock);
    detected.points.insert(detected.points.end(), block.begin(), block.end());
  });
  detection->for_each_boundary_point([&](const BoundaryPoint& p) { detected.boundary.push_back(p); });
  for (std::size_t i = 0; i < detection->loops.size(); ++i) detected.loops.push_back(detection->read_loop(i));
  return detected;
}

}  // namespace lacuna
