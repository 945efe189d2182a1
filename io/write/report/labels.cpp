// SPDX-License-Identifier: Apache-2.0
#include "io/write/report/labels.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace lacuna::io {
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
