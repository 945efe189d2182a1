// SPDX-License-Identifier: Apache-2.0
#include "python/arrays.hpp"

#include "engine/criteria/criteria.hpp"
#include "engine/run/error.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

namespace py = pybind11;

namespace lacuna::python {
namespace {

io::Scalar scalar_of(const py::dtype& type, const std::string& name) {
  constexpr std::array<std::pair<const char*, io::Scalar>, 8> kTypes = {{{"int8", io::Scalar::kInt8},
                                                                         {"uint8", io::Scalar::kUint8},
                                                                         {"int16", io::Scalar::kInt16},
                                                                         {"uint16", io::Scalar::kUint16},
                                                                         {"int32", io::Scalar::kInt32},
                                                                         {"uint32", io::Scalar::kUint32},
                                                                         {"float32", io::Scalar::kFloat32},
                                                                         {"float64", io::Scalar::kFloat64}}};
  for (const auto& [numpy_name, scalar] : kTypes) {
    if (type.equal(py::dtype(numpy_name))) return scalar;
  }
  throw Error(name + ": has values of type " + type.attr("name").cast<std::string>() +
              "; allowed: int8, uint8, int16, uint16, int32, uint32, float32, float64");
}

// Rows of `columns` values each.
template <class Value>
py::array_t<Value> table(std::size_t rows, std::size_t columns) {
  return py::array_t<Value>({static_cast<py::ssize_t>(rows), static_cast<py::ssize_t>(columns)});
}
template <class Value>
py::array_t<Value> column(std::size_t rows) {
  return py::array_t<Value>(static_cast<py::ssize_t>(rows));
}

template <class Vector, class Value>
void store(const Vector& vector, Value* to) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = vector[axis];
}

// Results of points in arrays that Python has. Filled without Python's lock.
class PointArrays {
 public:
  explicit PointArrays(std::size_t points)
      : criteria_count_(criteria().size()),
        probability_(column<float>(points)),
        criteria_(table<float>(points, criteria_count_)),
        boundary_(column<bool>(points)),
        coherent_(column<bool>(points)),
        loop_(column<std::int32_t>(points)),
        normal_(table<float>(points, 3)),
        to_{probability_.mutable_data(), criteria_.mutable_data(), boundary_.mutable_data(),
            coherent_.mutable_data(),    loop_.mutable_data(),     normal_.mutable_data()} {}

  void fill(std::size_t first, std::span<const PointResult> block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      const PointResult& from = block[i];
      const std::size_t row = first + i;
      to_.probability[row] = from.probability;
      std::copy_n(from.criteria.begin(), criteria_count_, to_.criteria + row * criteria_count_);
      to_.boundary[row] = from.boundary != 0;
      to_.coherent[row] = from.coherent != 0;
      to_.loop[row] = from.loop;
      store(from.normal, to_.normal + 3 * row);
    }
  }

  py::dict dict() const {
    py::dict all;
    all["probability"] = probability_;
    all["criteria"] = criteria_;
    all["boundary"] = boundary_;
    all["coherent"] = coherent_;
    all["loop"] = loop_;
    all["normal"] = normal_;
    return all;
  }

 private:
  std::size_t criteria_count_;
  py::array_t<float> probability_, criteria_;
  py::array_t<bool> boundary_, coherent_;
  py::array_t<std::int32_t> loop_;
  py::array_t<float> normal_;
  struct {
    float *probability, *criteria;
    bool *boundary, *coherent;
    std::int32_t* loop;
    float* normal;
  } to_;
};

// One value of each loop's measures.
template <class Value, class Of>
py::array_t<Value> measures(const std::vector<io::ExplainedLoop>& loops, Of&& of) {
  py::array_t<Value> values = column<Value>(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i)
    values.mutable_at(static_cast<py::ssize_t>(i)) = of(loops[i]);
  return values;
}
template <class Of>
py::array_t<double> vectors(const std::vector<io::ExplainedLoop>& loops, Of&& of) {
  py::array_t<double> values = table<double>(loops.size(), 3);
  for (std::size_t i = 0; i < loops.size(); ++i) store(of(loops[i]), values.mutable_data() + 3 * i);
  return values;
}

}  // namespace

io::ScanArrays scan_of(const py::dict& columns) {
  io::ScanArrays scan;
  bool is_first = true;
  for (const auto& [key, value] : columns) {
    const auto name = key.cast<std::string>();
    const auto array = py::cast<py::array>(value);
    if (array.ndim() != 1)
      throw Error(name + ": has " + std::to_string(array.ndim()) + " dimensions; allowed: 1");
    const auto rows = static_cast<std::uint64_t>(array.shape(0));
    if (!std::exchange(is_first, false) && rows != scan.rows)
      throw Error(name + ": has " + std::to_string(rows) + " values for " + std::to_string(scan.rows) +
                  " points; allowed: one for each point");
    scan.rows = rows;
    scan.columns.push_back({name, scalar_of(array.dtype(), name), static_cast<const std::byte*>(array.data()),
                            static_cast<std::ptrdiff_t>(array.strides(0))});
  }
  return scan;
}

py::dict loops_of(const io::ExplainedDetection& detection) {
  std::vector<io::ExplainedLoop> loops;
  for (std::size_t i = 0; i < detection.loops.size(); ++i) loops.push_back(detection.loop(i));
  py::array_t<std::int64_t> offsets = column<std::int64_t>(loops.size() + 1);
  offsets.mutable_at(0) = 0;
  std::size_t points = 0;
  for (std::size_t i = 0; i < loops.size(); ++i)
    offsets.mutable_at(static_cast<py::ssize_t>(i) + 1) =
        static_cast<std::int64_t>(points += loops[i].points);
  py::array_t<std::int64_t> ids = column<std::int64_t>(points);
  py::array_t<double> xyz = table<double>(points, 3);
  py::array_t<float> probability = column<float>(points);
  {
    std::int64_t* id = ids.mutable_data();
    double* position = xyz.mutable_data();
    float* of_point = probability.mutable_data();
    const py::gil_scoped_release unlocked;
    for (std::size_t i = 0; i < loops.size(); ++i) {
      detection.for_each_loop_point(i, [&](const LoopPoint& p) {
        *id++ = static_cast<std::int64_t>(value(p.id));
        store(p.position(), position);
        position += 3;
        *of_point++ = p.probability;
      });
    }
  }
  using M = io::ExplainedLoop;
  py::dict all;
  all["is_outer"] = measures<bool>(loops, [](const M& m) { return m.kind == LoopKind::kOuter; });
  all["parent"] = measures<std::int64_t>(loops, [](const M& m) { return m.parent; });
  all["confidence"] = measures<double>(loops, [](const M& m) { return m.track.confidence; });
  all["points"] =
      measures<std::int64_t>(loops, [](const M& m) { return static_cast<std::int64_t>(m.points); });
  all["perimeter"] = measures<double>(loops, [](const M& m) { return m.perimeter; });
  all["area"] = measures<double>(loops, [](const M& m) { return m.area; });
  all["diameter"] = measures<double>(loops, [](const M& m) { return m.diameter; });
  all["centroid"] = vectors(loops, [](const M& m) { return m.centroid; });
  all["normal"] = vectors(loops, [](const M& m) { return m.normal; });
  all["planarity"] = measures<double>(loops, [](const M& m) { return m.planarity; });
  all["mean_probability"] = measures<double>(loops, [](const M& m) { return m.mean_probability; });
  all["prominence"] = measures<double>(loops, [](const M& m) { return m.track.evidence.prominence; });
  all["first_scale"] = measures<double>(loops, [](const M& m) { return m.track.first_scale; });
  py::array_t<double> shares = table<double>(loops.size(), io::kCauses);
  for (std::size_t i = 0; i < loops.size(); ++i)
    std::ranges::copy(loops[i].cause.shares, shares.mutable_data() + io::kCauses * i);
  all["cause_shares"] = shares;
  all["hidden_by"] = vectors(loops, [](const M& m) { return m.cause.hidden_by; });
  all["last_scale"] = measures<double>(loops, [](const M& m) { return m.track.last_scale; });
  all["offsets"] = offsets;
  all["ids"] = ids;
  all["xyz"] = xyz;
  all["probability"] = probability;
  return all;
}

py::dict points_of(const Detection& detection) {
  if (!detection.for_each_result_block)
    throw Error("the run kept no results of points; find the holes with points=True");
  PointArrays arrays(detection.summary.counts.points);
  {
    const py::gil_scoped_release unlocked;
    detection.for_each_result_block(
        [&](PointId first, std::span<const PointResult> block) { arrays.fill(value(first), block); });
  }
  return arrays.dict();
}

py::dict block_of(PointId first, std::span<const PointResult> block) {
  PointArrays arrays(block.size());
  arrays.fill(0, block);
  py::dict all = arrays.dict();
  all["first_id"] = value(first);
  return all;
}

py::dict sample_of(const Detection& detection) {
  const std::size_t count = detection.sampled_points;
  py::array_t<std::int64_t> ids = column<std::int64_t>(count);
  py::array_t<double> xyz = table<double>(count, 3);
  py::array_t<float> probability = column<float>(count), normal = table<float>(count, 3);
  {
    std::int64_t* id = ids.mutable_data();
    double* position = xyz.mutable_data();
    float *of_point = probability.mutable_data(), *direction = normal.mutable_data();
    const py::gil_scoped_release unlocked;
    detection.for_each_sampled_point([&](const SampledPoint& p) {
      *id++ = static_cast<std::int64_t>(value(p.id));
      store(p.position(), position);
      *of_point++ = p.probability;
      store(p.normal, direction);
      position += 3;
      direction += 3;
    });
  }
  py::dict all;
  all["id"] = ids;
  all["xyz"] = xyz;
  all["probability"] = probability;
  all["normal"] = normal;
  return all;
}

py::dict summary_of(const io::ExplainedDetection& detection) {
  const Summary& summary = detection.summary;
  py::dict all;
  const Counts& c = summary.counts;
  for (const auto& [name, count] : std::initializer_list<std::pair<const char*, std::uint64_t>>{
           {"points", c.points},
           {"dropped", c.dropped},
           {"thinned_out", c.thinned_out},
           {"duplicates", c.duplicates},
           {"candidates", c.candidates},
           {"coherent", c.coherent},
           {"boundary_points", c.boundary_points},
           {"undefined_normals", c.undefined_normals}})
    all[name] = count;
  const auto list = [](const Eigen::Vector3d& v) { return py::cast(std::array{v.x(), v.y(), v.z()}); };
  py::dict bounds;
  bounds["min"] = list(summary.bounds.min());
  bounds["max"] = list(summary.bounds.max());
  all["bounds"] = summary.bounds.isEmpty() ? py::object(py::none()) : py::object(bounds);
  all["mean_neighbours"] = summary.mean_neighbours;
  all["mean_edge_length"] = summary.mean_edge_length;
  all["median_distance"] = summary.median_distance;
  all["surface_area"] = summary.surface_area;
  all["hole_area"] = summary.hole_area;
  all["opening_area"] = detection.opening_area();
  py::list levels;
  for (const LevelSummary& level : summary.levels) {
    py::dict one;
    one["edge"] = level.edge;
    one["points"] = level.points;
    one["loops"] = level.loops;
    levels.append(one);
  }
  all["levels"] = levels;
  py::dict phases;
  for (const PhaseTime& phase : summary.phases) phases[py::str(phase.name)] = phase.seconds;
  all["seconds"] = phases;
  all["threads"] = summary.threads;
  all["memory_limit"] = summary.memory_limit;
  return all;
}

}  // namespace lacuna::python
