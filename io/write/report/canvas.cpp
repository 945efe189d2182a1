// SPDX-License-Identifier: Apache-2.0
#include "io/write/report/render.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace lacuna::io {

Canvas::Canvas(PictureSize size, std::size_t first_row, std::size_t rows)
    : width_(static_cast<int>(size.width) * kFiner),
      height_(static_cast<int>(size.height) * kFiner),
      first_(static_cast<int>(first_row) * kFiner),
      end_(static_cast<int>(first_row + rows) * kFiner),
      colours_(size.width * rows * kFiner * kFiner, kPaper),
      depths_(colours_.size(), -std::numeric_limits<float>::infinity()) {}

template <class Visit>
void Canvas::for_each_between(int row, float left, float right, const Visit& visit) const {
  const auto limit = [&](float x) { return std::clamp(x, -1.0f, static_cast<float>(width_)); };
  const int first = std::max(0, static_cast<int>(std::ceil(limit(left))));
  const int last = std::min(width_ - 1, static_cast<int>(std::floor(limit(right))));
  for (int column = first; column <= last; ++column)
    visit(std::size_t(row - first_) * std::size_t(width_) + std::size_t(column));
}

template <class Visit>
void Canvas::for_each_in_disc(float x, float y, float radius, const Visit& visit) const {
  if (!reaches(y - radius, y + radius)) return;
  const int top = std::max(first_, static_cast<int>(std::ceil(y - radius)));
  const int bottom = std::min(end_ - 1, static_cast<int>(std::floor(y + radius)));
  for (int row = top; row <= bottom; ++row) {
    const float half = std::sqrt(std::max(0.0f, radius * radius - (float(row) - y) * (float(row) - y)));
    for_each_between(row, x - half, x + half, visit);
  }
}

void Canvas::disc(float x, float y, float radius, float depth, const Eigen::Vector3f& colour) {
  for_each_in_disc(x, y, radius, [&](std::size_t at) {
    if (depth < depths_[at]) return;
    depths_[at] = depth;
    colours_[at] = colour;
  });
}

bool Canvas::shows(float x, float y, float depth) const {
  bool is_shown = false;
  for_each_in_disc(std::round(x), std::round(y), 0, [&](std::size_t at) { is_shown = depth >= depths_[at]; });
  return is_shown;
}

void Canvas::overlay(float x, float y, float radius, const Eigen::Vector3f& colour) {
  for_each_in_disc(x, y, radius, [&](std::size_t at) { colours_[at] = colour; });
}

void Canvas::overlay_box(float left, float top, float right, float bottom, const Eigen::Vector3f& colour) {
  const int last = std::min(end_ - 1, static_cast<int>(std::ceil(bottom)) - 1);
  for (int row = std::max(first_, static_cast<int>(std::ceil(top))); row <= last; ++row)
    for_each_between(row, left, std::ceil(right) - 1, [&](std::size_t at) { colours_[at] = colour; });
}

void Canvas::veil(const std::vector<Eigen::Vector3f>& outline, const Eigen::Vector3f& plane) {
  std::vector<float> crossings;
  for (int row = first_; row < end_; ++row) {
    const auto y = static_cast<float>(row);
    crossings.clear();
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Eigen::Vector3f &a = outline[i], &b = outline[(i + 1) % outline.size()];
      if ((a.y() > y) != (b.y() > y))
        crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
      for_each_between(row, crossings[i], crossings[i + 1], [&](std::size_t at) {
        const std::size_t column = at % static_cast<std::size_t>(width_);
        if (depths_[at] < plane.dot(Eigen::Vector3f(static_cast<float>(column), y, 1)))
          colours_[at] = pale(colours_[at]);
      });
  }
}

void Canvas::take_rows(const std::function<void(std::span<const Colour>)>& take_row) const {
  std::vector<Colour> pixels;
  for (int row = 0; row < end_ - first_; row += kFiner) {
    pixels.clear();
    for (int column = 0; column < width_; column += kFiner) {
      Eigen::Vector3f sum(0.5f * kFiner * kFiner, 0.5f * kFiner * kFiner, 0.5f * kFiner * kFiner);
      for (int i = 0; i < kFiner * kFiner; ++i)
        sum +=
            colours_[std::size_t(row + i / kFiner) * std::size_t(width_) + std::size_t(column + i % kFiner)];
      const Eigen::Vector3f mean = sum / (kFiner * kFiner);
      pixels.push_back({std::uint8_t(mean.x()), std::uint8_t(mean.y()), std::uint8_t(mean.z())});
    }
    take_row(pixels);
  }
}

namespace {

constexpr std::size_t kMostLabels = 60;
constexpr int kWidth = 5, kHeight = 7;  // of a digit, in dots
constexpr int kStep = kWidth + 1;       // from a digit to the next one
const Eigen::Vector3f kInk(30, 34, 40);

// The digits, row by row from the top.
constexpr std::array<std::string_view, 10> kDigits = {
    " ### #   ##  ### # ###  ##   # ### ", "  #   ##    #    #    #    #   ### ",
    " ### #   #    #   #   #   #   #####", "#####   #   #     #     ##   # ### ",
    "   #   ##  # # #  # #####   #    # ", "######    ####     #    ##   # ### ",
    "  ##  #   #    #### #   ##   # ### ", "#####    #   #   #   #    #    #   ",
    " ### #   ##   # ### #   ##   # ### ", " ### #   ##   # ####    #   #  ##  "};

// Parts of the canvas in a dot.
float dot_of(PictureSize size) {
  return static_cast<float>(std::max<std::size_t>(2, size.height / 350) * kFiner);
}

// Half the width and height of a number, with its border of a dot.
Eigen::Vector2f half_of(std::uint64_t number, float dot) {
  const auto digits = static_cast<float>(std::to_string(number).size());
  return {dot * (digits * kStep + 1) / 2, dot * (kHeight + 2) / 2};
}

Eigen::AlignedBox2f box_of(const Label& label, float dot) {
  const Eigen::Vector2f half = half_of(label.number, dot);
  return {label.middle - half, label.middle + half};
}

Label label_of(const Labelled& wanted, float dot) {
  const Eigen::Vector2f half = half_of(wanted.number, dot);
  Label label{wanted.number, wanted.box.center()};
  if ((wanted.box.sizes() - 2 * half).minCoeff() < 0) label.middle.x() = wanted.box.max().x() + half.x();
  return label;
}

}  // namespace

std::vector<Label> place_labels(const std::vector<Labelled>& wanted, PictureSize size) {
  const float dot = dot_of(size);
  const Eigen::AlignedBox2f picture(Eigen::Vector2f(0, 0),
                                    kFiner * Eigen::Vector2f(float(size.width), float(size.height)));
  std::vector<Label> labels;
  for (const Labelled& one : wanted) {
    if (labels.size() == kMostLabels) break;
    const Label label = label_of(one, dot);
    const Eigen::AlignedBox2f box = box_of(label, dot);
    const auto overlaps = [&](const Label& other) { return box.intersects(box_of(other, dot)); };
    if (picture.contains(box) && std::ranges::none_of(labels, overlaps)) labels.push_back(label);
  }
  return labels;
}

void draw_label(const Label& label, PictureSize size, Canvas& canvas) {
  const float dot = dot_of(size);
  // Dots fill pixels as a whole.
  const Eigen::Vector2f corner = kFiner * (box_of(label, dot).min() / kFiner).array().round();
  const std::string digits = std::to_string(label.number);
  // A dot's border first, so that no border lies on a dot.
  for (const float border : {dot, 0.0f}) {
    for (std::size_t i = 0; i < digits.size(); ++i) {
      const std::string_view digit = kDigits[std::size_t(digits[i] - '0')];
      for (int at = 0; at < kWidth * kHeight; ++at) {
        if (digit[std::size_t(at)] == ' ') continue;
        const float left = corner.x() + dot * float(1 + int(i) * kStep + at % kWidth);
        const float top = corner.y() + dot * float(1 + at / kWidth);
        canvas.overlay_box(left - border, top - border, left + dot + border, top + dot + border,
                           border > 0 ? kPaper : kInk);
      }
    }
  }
}

}  // namespace lacuna::io
