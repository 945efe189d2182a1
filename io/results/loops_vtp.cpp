// SPDX-License-Identifier: Apache-2.0
// The form: VTK, "VTK XML Formats", appended raw data.
#include "io/results/loops_vtp.hpp"

#include "io/results/loop_measures.hpp"

#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace lacuna::io {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they are in memory");

template <class T>
void put(OutputFile& out, T value) {
  static_assert(std::is_arithmetic_v<T>);
  out.write(std::as_bytes(std::span(&value, 1)));
}

// An array of the file: declared in XML, its bytes at the end.
struct Array {
  std::string section;  // "Points", "PointData", "CellData", "Lines"
  std::string name;
  std::string type;
  int components;
  std::uint64_t bytes;
  std::function<void(OutputFile& out)> write;
};

class LoopArrays {
 public:
  explicit LoopArrays(const ExplainedDetection& detection)
      : detection_(detection), loops_(detection.loops.size()) {
    for (const LoopMeasures& loop : detection.loops) points_ += loop.points;
    add_points();
    add_lines();
  }

  std::uint64_t points() const { return points_; }
  std::uint64_t loops() const { return loops_; }
  const std::vector<Array>& list() const { return arrays_; }

 private:
  // `put_point(out, point)` puts as many bytes for each.
  template <class PutPoint>
  void add_for_points(std::string section, std::string name, std::string type, int components,
                      std::size_t bytes, PutPoint put_point) {
    arrays_.push_back({std::move(section), std::move(name), std::move(type), components, points_ * bytes,
                       [this, put_point](OutputFile& out) {
                         for (std::size_t i = 0; i < loops_; ++i) {
                           detection_.for_each_loop_point(
                               i, [&](const LoopPoint& point) { put_point(out, point); });
                         }
                       }});
  }
  // `value_of(index, loop)`: a number of 8 bytes.
  template <class ValueOf>
  void add_for_loops(std::string section, std::string name, std::string type, ValueOf value_of) {
    arrays_.push_back({std::move(section), std::move(name), std::move(type), 1, loops_ * 8,
                       [this, value_of](OutputFile& out) {
                         for (std::size_t i = 0; i < loops_; ++i) put(out, value_of(i, detection_.loop(i)));
                       }});
  }

  void add_points() {
    add_for_points("PointData", "id", "Int64", 1, 8, [](OutputFile& out, const LoopPoint& point) {
      put(out, static_cast<std::int64_t>(value(point.id)));
    });
    add_for_points("PointData", "probability", "Float32", 1, 4,
                   [](OutputFile& out, const LoopPoint& point) { put(out, point.probability); });
    add_for_points("Points", "Points", "Float64", 3, 24, [](OutputFile& out, const LoopPoint& point) {
      for (const double component : point.position) put(out, component);
    });
  }

  void add_lines() {
    add_for_loops("CellData", "id", "Int64",
                  [](std::size_t i, const ExplainedLoop&) { return static_cast<std::int64_t>(i); });
    add_for_loops("CellData", "kind", "Int64", [](std::size_t, const ExplainedLoop& loop) {
      return static_cast<std::int64_t>(loop.kind == LoopKind::kOuter);
    });
    for (const LoopMeasure& measure : kLoopMeasures) {
      const std::string name(measure.name);
      if (measure.is_count) {
        add_for_loops("CellData", name, "Int64", [of = measure.of](std::size_t, const ExplainedLoop& loop) {
          return static_cast<std::int64_t>(of(loop));
        });
      } else {
        add_for_loops("CellData", name, "Float64",
                      [of = measure.of](std::size_t, const ExplainedLoop& loop) { return of(loop); });
      }
    }
    arrays_.push_back({"Lines", "connectivity", "Int64", 1, (points_ + loops_) * 8, [this](OutputFile& out) {
                         std::int64_t first = 0;
                         for (const LoopMeasures& loop : detection_.loops) {
                           const auto end = first + static_cast<std::int64_t>(loop.points);
                           for (std::int64_t i = first; i < end; ++i) put(out, i);
                           put(out, first);  // closed
                           first = end;
                         }
                       }});
    arrays_.push_back({"Lines", "offsets", "Int64", 1, loops_ * 8, [this](OutputFile& out) {
                         std::int64_t end = 0;
                         for (const LoopMeasures& loop : detection_.loops)
                           put(out, end += static_cast<std::int64_t>(loop.points) + 1);
                       }});
  }

  const ExplainedDetection& detection_;
  std::uint64_t loops_ = 0, points_ = 0;
  std::vector<Array> arrays_;
};

// Arrays of a section follow one another.
std::string declare(const std::vector<Array>& arrays) {
  std::string text, section;
  std::uint64_t offset = 0;
  for (const Array& array : arrays) {
    if (array.section != section) {
      if (!section.empty()) text += "      </" + section + ">\n";
      section = array.section;
      text += "      <" + section + ">\n";
    }
    text += "        <DataArray type=\"" + array.type + "\" Name=\"" + array.name +
            "\" NumberOfComponents=\"" + std::to_string(array.components) +
            "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
    offset += sizeof(std::uint64_t) + array.bytes;
  }
  return text + "      </" + section + ">\n";
}

}  // namespace

void write_loops_vtp(const ExplainedDetection& detection, OutputFile& out) {
  const LoopArrays arrays(detection);
  out.write(kVtpMark);
  out.write(
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n");
  out.write("  <PolyData>\n    <Piece NumberOfPoints=\"" + std::to_string(arrays.points()) +
            "\" NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(arrays.loops()) +
            "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n");
  out.write(declare(arrays.list()));
  out.write("    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_");
  for (const Array& array : arrays.list()) {
    put(out, array.bytes);
    array.write(out);
  }
  out.write("\n  </AppendedData>\n</VTKFile>\n");
}

}  // namespace lacuna::io
