// SPDX-License-Identifier: Apache-2.0
// Group codes: AutoCAD 2012 DXF Reference; release 12: its Customization Manual, chapter 11.
#include "io/results/loops_dxf.hpp"

#include "io/results/digits.hpp"
#include "io/results/loop_colours.hpp"
#include "io/results/loop_measures.hpp"

#include <cmath>
#include <string>

namespace lacuna::io {
namespace {

constexpr const char* kApplication = "LACUNA";

const char* layer_of(LoopKind kind) {
  return kind == LoopKind::kHole ? "holes" : "outer_curves";
}

// Pairs of a group code and its value, a line each.
class DxfText {
 public:
  explicit DxfText(OutputFile& out) : out_(out) {}

  void put(int code, std::string_view value) {
    line_ = std::to_string(code) + "\n";
    out_.write((line_ += value) += "\n");
  }
  void put_whole(int code, std::uint64_t value) { put(code, std::to_string(value)); }
  void put_real(int code, double value) {
    std::string digits;
    append_plain(digits, value);
    if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
    put(code, digits);
  }
  // The codes of its three coordinates are 10 apart.
  void put_point(int code, const Eigen::Vector3d& point) {
    for (int axis = 0; axis < 3; ++axis) put_real(code + 10 * axis, point[axis]);
  }

 private:
  OutputFile& out_;
  std::string line_;
};

void put_header(DxfText& dxf, const Eigen::AlignedBox3d& bounds) {
  dxf.put(0, "SECTION");
  dxf.put(2, "HEADER");
  dxf.put(9, "$ACADVER");
  dxf.put(1, "AC1009");  // release 12
  if (!bounds.isEmpty()) {
    dxf.put(9, "$EXTMIN");
    dxf.put_point(10, bounds.min());
    dxf.put(9, "$EXTMAX");
    dxf.put_point(10, bounds.max());
  }
  dxf.put(0, "ENDSEC");
}

void begin_table(DxfText& dxf, const char* name, std::uint64_t entries) {
  dxf.put(0, "TABLE");
  dxf.put(2, name);
  dxf.put_whole(70, entries);
}

// What the entities name: their line type, their layers and the owner of their extended data.
void put_tables(DxfText& dxf) {
  dxf.put(0, "SECTION");
  dxf.put(2, "TABLES");
  begin_table(dxf, "LTYPE", 1);
  dxf.put(0, "LTYPE");
  dxf.put(2, "CONTINUOUS");
  dxf.put_whole(70, 0);
  dxf.put(3, "Solid line");
  dxf.put_whole(72, 65);
  dxf.put_whole(73, 0);
  dxf.put_real(40, 0);
  dxf.put(0, "ENDTAB");

  begin_table(dxf, "LAYER", 3);
  const auto put_layer = [&](const char* name, int colour) {
    dxf.put(0, "LAYER");
    dxf.put(2, name);
    dxf.put_whole(70, 0);
    dxf.put_whole(62, static_cast<std::uint64_t>(colour));
    dxf.put(6, "CONTINUOUS");
  };
  put_layer("0", 7);  // each drawing has it
  for (const LoopKind kind : {LoopKind::kHole, LoopKind::kOuter})
    put_layer(layer_of(kind), colour_of(kind).index);
  dxf.put(0, "ENDTAB");

  begin_table(dxf, "APPID", 1);
  dxf.put(0, "APPID");
  dxf.put(2, kApplication);
  dxf.put_whole(70, 0);
  dxf.put(0, "ENDTAB");
  dxf.put(0, "ENDSEC");
}

// Extended data: strings 1000, reals 1040, whole numbers of 32 bits 1071.
void put_measures(DxfText& dxf, std::size_t id, const ExplainedLoop& loop) {
  dxf.put(1001, kApplication);
  dxf.put(1000, "id");
  dxf.put_whole(1071, id);
  dxf.put(1000, "kind");
  dxf.put(1000, name_of(loop.kind));
  if (!loop.cause.name().empty()) {
    dxf.put(1000, "cause");
    dxf.put(1000, loop.cause.name());
  }
  for (const LoopMeasure& measure : kLoopMeasures) {
    const double value = measure.of(loop);
    if (!std::isfinite(value)) continue;
    dxf.put(1000, measure.name);
    if (measure.is_count) {
      dxf.put_whole(1071, static_cast<std::uint64_t>(value));
    } else {
      dxf.put_real(1040, value);
    }
  }
}

void put_loop(DxfText& dxf, std::size_t id, const ExplainedDetection& detection) {
  constexpr int kClosed = 1, k3D = 8, k3DVertex = 32;
  const ExplainedLoop measures = detection.loop(id);
  const char* const layer = layer_of(measures.kind);
  dxf.put(0, "POLYLINE");
  dxf.put(8, layer);
  dxf.put_whole(66, 1);  // vertices follow
  dxf.put_point(10, {0, 0, 0});
  dxf.put_whole(70, kClosed + k3D);
  put_measures(dxf, id, measures);
  detection.for_each_loop_point(id, [&](const LoopPoint& point) {
    dxf.put(0, "VERTEX");
    dxf.put(8, layer);
    dxf.put_point(10, point.position);
    dxf.put_whole(70, k3DVertex);
  });
  dxf.put(0, "SEQEND");
  dxf.put(8, layer);
}

}  // namespace

void write_loops_dxf(const ExplainedDetection& detection, OutputFile& out) {
  DxfText dxf(out);
  out.write(kDxfMark);
  put_header(dxf, detection.summary.bounds);
  put_tables(dxf);
  dxf.put(0, "SECTION");
  dxf.put(2, "ENTITIES");
  for (std::size_t id = 0; id < detection.loops.size(); ++id) put_loop(dxf, id, detection);
  dxf.put(0, "ENDSEC");
  dxf.put(0, "EOF");
}

}  // namespace lacuna::io
