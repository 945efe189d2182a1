// SPDX-License-Identifier: Apache-2.0
#include "io/scan/posed_reader.hpp"

#include "io/rows/scalar.hpp"
#include "io/rows/vectors.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

// `pose` moves positions, and `turn` normals. `is_of_scanner`: the scan begins at its scanner's place.
class PosedReader final : public ScanReader {
 public:
  PosedReader(std::unique_ptr<ScanReader> reader, const Pose& pose, const Eigen::Matrix3d& turn,
              bool is_of_scanner)
      : reader_(std::move(reader)), pose_(pose), turn_(turn), is_of_scanner_(is_of_scanner) {
    std::vector<std::pair<std::string, Scalar>> columns;
    for (const Property& property : reader_->layout().properties) {
      const bool is_moved =
          is_component(property.name, kPositionNames) || is_component(property.name, kNormalNames);
      columns.emplace_back(property.name, is_moved ? Scalar::kFloat64 : property.type);
    }
    layout_ = packed_layout(columns);
  }

  std::string format() const override { return reader_->format(); }
  const RowLayout& layout() const override { return layout_; }
  std::optional<std::uint64_t> expected_rows() const override { return reader_->expected_rows(); }
  bool is_slow() const override { return reader_->is_slow(); }
  std::string length_unit() const override {
    const bool is_rigid = std::abs(pose_.linear().determinant() - 1) < 1e-6;
    return is_rigid ? reader_->length_unit() : "";
  }
  std::vector<Eigen::Vector3d> no_return_places() const override {
    std::vector<Eigen::Vector3d> places = reader_->no_return_places();
    for (Eigen::Vector3d& place : places) place = pose_ * place;
    return places;
  }

  // A scan that is moved to its place, and names no scanner, begins at its own.
  std::vector<ScannerPose> scanners() const override {
    std::vector<ScannerPose> scanners = reader_->scanners();
    if (scanners.empty() && is_of_scanner_) scanners.push_back({.place = Eigen::Vector3d::Zero()});
    for (ScannerPose& scanner : scanners) {
      scanner.place = pose_ * scanner.place;
      scanner.axis = (pose_.linear() * scanner.axis).normalized();
    }
    return scanners;
  }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    if (!reader_->next(rows_, max_rows)) return false;
    batch.count = rows_.count;
    batch.bytes.resize(rows_.count * layout_.stride);
    copy_all(batch);
    load_vectors(batch, layout_, kPositionNames, vectors_);
    for (Eigen::Vector3d& position : vectors_) position = pose_ * position;
    store_vectors(vectors_, layout_, kPositionNames, batch);
    if (!has_vectors(layout_, kNormalNames)) return true;
    load_vectors(batch, layout_, kNormalNames, vectors_);
    for (Eigen::Vector3d& normal : vectors_) normal = turn_ * normal;
    store_vectors(vectors_, layout_, kNormalNames, batch);
    return true;
  }

 private:
  void copy_all(RowBatch& batch) const {
    for (std::size_t i = 0; i < layout_.properties.size(); ++i) {
      const Property &from = reader_->layout().properties[i], &to = layout_.properties[i];
      copy_column(
          {.data = rows_.bytes.data() + from.offset, .stride = reader_->layout().stride, .type = from.type},
          {.data = batch.bytes.data() + to.offset, .stride = layout_.stride, .type = to.type}, rows_.count);
    }
  }

  std::unique_ptr<ScanReader> reader_;
  Pose pose_;
  Eigen::Matrix3d turn_;
  bool is_of_scanner_;
  RowLayout layout_;
  RowBatch rows_;  // as the reader gives them
  std::vector<Eigen::Vector3d> vectors_;
};

}  // namespace

std::unique_ptr<ScanReader> posed(std::unique_ptr<ScanReader> reader, const Pose& pose) {
  const Eigen::Matrix3d turn = pose.linear() / std::cbrt(pose.linear().determinant());
  return std::make_unique<PosedReader>(std::move(reader), pose, turn, true);
}

std::unique_ptr<ScanReader> with_z_times(std::unique_ptr<ScanReader> reader, double factor) {
  Pose pose = Pose::Identity();
  pose.linear()(2, 2) = factor;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn(2, 2) = 1 / factor;
  return std::make_unique<PosedReader>(std::move(reader), pose, turn, false);
}

}  // namespace lacuna::io
