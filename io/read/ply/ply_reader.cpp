// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/input_file.hpp"
#include "io/read/ply/ply.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/readers.hpp"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {
namespace {

// The camera of a PLY file: the place of its scanner. VCGlib (MeshLab) writes it before the vertices, PCL
// after them.

constexpr VectorNames kViewpointNames = {"view_px", "view_py", "view_pz"};

bool states_viewpoint(const PlyElement& element) {
  return element.name == "camera" && element.count == 1 && has_vectors(element.layout(), kViewpointNames);
}

// Returns the properties view_px, view_py and view_pz of element `camera`, in the coordinates of the file.
// Returns nothing unless the element has these properties and exactly one row. `header` is the file's header,
// after require_size(). Cost: the function passes over the rows before the camera. Throws `Error` if the file
// ends before the camera, or a number is not finite.
std::optional<Eigen::Vector3d> read_ply_camera(const std::filesystem::path& file, const PlyHeader& header) {
  const auto camera = std::find_if(header.elements.begin(), header.elements.end(), states_viewpoint);
  if (camera == header.elements.end()) return std::nullopt;
  InputFile in(file);
  read_ply_header(in);
  for (auto element = header.elements.begin(); element != camera; ++element)
    skip_rows(in, header.format, *element);
  const std::uint64_t begin = in.position();
  const RowLayout layout = camera->layout();
  RowBatch row{.count = 1, .bytes = std::vector<std::byte>(layout.stride)};
  read_rows(in, header.format, *camera, 1, row.bytes.data());
  std::vector<Eigen::Vector3d> places;
  load_vectors(row, layout, kViewpointNames, places);
  if (!places[0].allFinite()) {
    const std::string reason = "the camera is at no place; view_px, view_py and view_pz must be finite";
    if (header.format == PlyFormat::kAscii) in.fail_at_line(in.line(), reason);
    in.fail_at_byte(begin, reason);
  }
  return places[0];
}

std::size_t find_vertex(const InputFile& in, const PlyHeader& header) {
  for (const std::string_view name : {"vertex", "vertices", "point", "points"}) {
    for (std::size_t i = 0; i < header.elements.size(); ++i)
      if (header.elements[i].name == name) return i;
  }
  in.fail_at_line(in.line(), "the header has no element 'vertex'; points are needed");
}

void require_position(const InputFile& in, const PlyElement& vertex) {
  const RowLayout layout = vertex.layout();
  for (const char* name : {"x", "y", "z"}) {
    if (!layout.find(name)) {
      in.fail_at_line(in.line(), "element 'vertex' has no scalar property " + in_quotes(name) +
                                     "; x, y and z are needed");
    }
  }
}

class PlyReader final : public ScanReader {
 public:
  explicit PlyReader(const std::filesystem::path& file) : in_(file), header_(read_ply_header(in_)) {
    const std::size_t vertex = find_vertex(in_, header_);
    require_position(in_, header_.elements[vertex]);
    require_size(in_, header_);
    element_ = vertex;
    layout_ = header_.elements[vertex].layout();
    left_ = header_.elements[vertex].count;
    camera_ = read_ply_camera(file, header_);
    for (std::size_t i = 0; i < vertex; ++i) skip_rows(in_, header_.format, header_.elements[i]);
  }

  std::string format() const override { return std::string("PLY, ") + ply_name(header_.format); }
  const RowLayout& layout() const override { return layout_; }

  std::vector<Eigen::Vector3d> no_return_places() const override {
    std::vector<Eigen::Vector3d> places{Eigen::Vector3d::Zero()};
    for (const ScannerPose& scanner : scanners()) places.push_back(scanner.place);
    return places;
  }
  bool has_scanner_at_zero() const override { return camera_ && camera_->isZero(0); }
  std::vector<ScannerPose> scanners() const override {
    if (!camera_ || has_scanner_at_zero()) return {};
    return {{.place = *camera_ + header_.offset.value_or(Eigen::Vector3d::Zero())}};
  }
  std::vector<ReaderNote> notes() const override {
    std::vector<ReaderNote> notes{
        {.count = header_.byes, .thing = "line", .what = " 'bye', no keyword of a header; ignored"}};
    for (const PlyElement& element : header_.elements) {
      if (element.name == "face") notes.push_back(note_of_faces(element.count));
      if (element.name == "tristrips") notes.push_back(note_of_faces(element.count, "triangle strip"));
    }
    return notes;
  }
  const LocalOffset& offset() const { return header_.offset; }

  std::optional<std::uint64_t> expected_rows() const override { return header_.elements[element_].count; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    assert(max_rows > 0);
    const std::size_t fitting = std::max<std::size_t>(1, kBatchBytes / layout_.stride);
    batch.count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, std::min(max_rows, fitting)));
    batch.bytes.resize(batch.count * layout_.stride);
    if (batch.count == 0) {
      finish();
      return false;
    }
    read_rows(in_, header_.format, header_.elements[element_], batch.count, batch.bytes.data());
    left_ -= batch.count;
    return true;
  }

 private:
  void finish() {
    if (finished_) return;
    for (std::size_t i = element_ + 1; i < header_.elements.size(); ++i) {
      skip_rows(in_, header_.format, header_.elements[i]);
    }
    require_end(in_);
    finished_ = true;
  }

  InputFile in_;
  PlyHeader header_;
  std::size_t element_ = 0;  // of the header, the vertices
  RowLayout layout_;
  std::optional<Eigen::Vector3d> camera_;
  std::uint64_t left_ = 0;  // vertices not yet read
  bool finished_ = false;
};

}  // namespace

bool looks_like_ply(const FileStart& start) {
  const std::string_view first_bytes = start.first_bytes;
  if (!first_bytes.starts_with("ply")) return false;
  return first_bytes.size() == 3 ||
         std::string_view(" \t\r\n").find(first_bytes[3]) != std::string_view::npos;
}

std::unique_ptr<ScanReader> open_ply(const std::filesystem::path& file, const ReadOptions&) {
  auto reader = std::make_unique<PlyReader>(file);
  const LocalOffset offset = reader->offset();
  return with_offset(std::move(reader), offset);
}

}  // namespace lacuna::io
