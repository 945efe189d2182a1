// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/row_filter.hpp"

#include "engine/run/error.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/rows/columns.hpp"

#include <algorithm>
#include <utility>

namespace lacuna::io {

// By recursive descent: or, and, not, then a comparison or what stands in parentheses.
class ConditionParser {
 public:
  ConditionParser(Condition& to, std::string_view text, const std::string& file, const RowLayout& layout)
      : to_(to), text_(text), rest_(text), file_(file), layout_(layout) {}

  std::size_t parse() {
    const std::size_t root = parse_or();
    if (!next_word().empty()) fail("a comparison ends before " + in_quotes(last_word_));
    return root;
  }

 private:
  using Kind = Condition::Kind;

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error("--where " + in_quotes(text_) + ": " + reason +
                "; allowed: comparisons (== != < <= > >=) of a column with a number or a column, and, or, "
                "not, parentheses");
  }

  // Takes a name, with its quotes if it has them, a number or a sign; empty at the end.
  std::string_view next_word() {
    const auto is_part = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
             c == '.' || c == '+' || c == '-';
    };
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size()));
    std::size_t size =
        static_cast<std::size_t>(std::find_if_not(rest_.begin(), rest_.end(), is_part) - rest_.begin());
    if (rest_.starts_with('"')) {
      const std::size_t end = rest_.find('"', 1);
      if (end == rest_.npos) fail("a name is not closed by a quote");
      size = end + 1;
    } else if (size == 0 && !rest_.empty()) {
      constexpr std::string_view kDouble[] = {"==", "!=", "<=", ">=", "&&", "||"};
      size = std::any_of(std::begin(kDouble), std::end(kDouble),
                         [&](std::string_view sign) { return rest_.starts_with(sign); })
                 ? 2
                 : 1;
    }
    last_word_ = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return last_word_;
  }
  bool take(std::initializer_list<std::string_view> words) {
    const std::string_view before = rest_, word = next_word();
    if (std::find(words.begin(), words.end(), lower_case(word)) != words.end()) return true;
    rest_ = before;
    return false;
  }

  std::size_t add(Condition::Node node) {
    to_.nodes_.push_back(node);
    return to_.nodes_.size() - 1;
  }

  std::size_t parse_or() {
    std::size_t a = parse_and();
    while (take({"or", "||"})) {
      const std::size_t b = parse_and();
      a = add({.kind = Kind::kOr, .a = a, .b = b});
    }
    return a;
  }
  std::size_t parse_and() {
    std::size_t a = parse_not();
    while (take({"and", "&&"})) {
      const std::size_t b = parse_not();
      a = add({.kind = Kind::kAnd, .a = a, .b = b});
    }
    return a;
  }
  std::size_t parse_not() {
    constexpr int kDeepest = 100;
    if (++depth_ > kDeepest) fail("parentheses and nots are nested too deeply");
    std::size_t node;
    if (take({"not", "!"})) {
      node = add({.kind = Kind::kNot, .a = parse_not()});
    } else if (take({"("})) {
      node = parse_or();
      if (!take({")"})) fail("a parenthesis is not closed");
    } else {
      node = parse_comparison();
    }
    --depth_;
    return node;
  }

  std::size_t parse_comparison() {
    const std::size_t column = find_column(next_word());
    constexpr std::pair<std::string_view, Kind> kSigns[] = {
        {"==", Kind::kEqual},       {"=", Kind::kEqual}, {"!=", Kind::kUnequal},
        {"<=", Kind::kLessOrEqual}, {"<", Kind::kLess},  {">=", Kind::kGreaterOrEqual},
        {">", Kind::kGreater}};
    const std::string_view sign = next_word();
    const auto* const found =
        std::find_if(std::begin(kSigns), std::end(kSigns), [&](const auto& s) { return s.first == sign; });
    if (found == std::end(kSigns)) fail(in_quotes(sign) + " is no comparison");
    double value;
    if (parse_number(next_word(), value)) {
      // As the column has it: the float nearest to 0.1 is above 0.1.
      if (to_.columns_[column].property.type == Scalar::kFloat32)
        value = static_cast<double>(nearest_float(value));
      return add({.kind = found->second, .a = column, .value = value});
    }
    return add({.kind = found->second, .a = column, .b = find_column(last_word_)});
  }

  std::size_t find_column(std::string_view name) {
    if (name.empty()) fail("a comparison is missing at the end");
    if (name.starts_with('"')) name = name.substr(1, name.size() - 2);
    const std::vector<const Property*> alike = layout_.all_alike(name);
    if (alike.size() != 1) {
      std::string names;
      const auto add = [&](const Property& p) { names += (names.empty() ? "" : ", ") + p.name; };
      for (const Property* p : alike) add(*p);
      if (!alike.empty())
        throw Error(file_ + ": several columns for " + in_quotes(name) + " of --where: " + names +
                    "; allowed: one of these names as it is");
      for (const Property& p : layout_.properties) add(p);
      throw Error(file_ + ": no column for " + in_quotes(name) + " of --where; the columns are " + names);
    }
    for (std::size_t i = 0; i < to_.columns_.size(); ++i) {
      if (to_.columns_[i].property.name == alike[0]->name) return i;
    }
    to_.columns_.push_back({*alike[0], {}});
    return to_.columns_.size() - 1;
  }

  Condition& to_;
  std::string_view text_, rest_, last_word_;
  const std::string& file_;
  const RowLayout& layout_;
  int depth_ = 0;
};

Condition::Condition(std::string_view text, const std::string& file, const RowLayout& layout)
    : stride_(layout.stride) {
  root_ = ConditionParser(*this, text, file, layout).parse();
}

void Condition::load(const RowBatch& rows) {
  for (Column& column : columns_) load_column(rows, stride_, column.property, column.values);
}

bool Condition::holds(std::size_t at, std::size_t row) const {
  const Node& node = nodes_[at];
  const auto left = [&] { return columns_[node.a].values[row]; };
  const auto right = [&] { return node.b == kNone ? node.value : columns_[node.b].values[row]; };
  switch (node.kind) {
    case Kind::kEqual:
      return left() == right();
    case Kind::kUnequal:
      return left() != right();
    case Kind::kLess:
      return left() < right();
    case Kind::kLessOrEqual:
      return left() <= right();
    case Kind::kGreater:
      return left() > right();
    case Kind::kGreaterOrEqual:
      return left() >= right();
    case Kind::kAnd:
      return holds(node.a, row) && holds(node.b, row);
    case Kind::kOr:
      return holds(node.a, row) || holds(node.b, row);
    case Kind::kNot:
      break;
  }
  return !holds(node.a, row);
}

namespace {

std::optional<Eigen::AlignedBox3d> box_of(std::span<const double> bounds) {
  if (bounds.empty()) return std::nullopt;
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const bool is_flat = bounds.size() == 4;
  const double* const min = bounds.data();
  const double* const max = min + bounds.size() / 2;
  return Eigen::AlignedBox3d(Eigen::Vector3d(min[0], min[1], is_flat ? -kInfinite : min[2]),
                             Eigen::Vector3d(max[0], max[1], is_flat ? kInfinite : max[2]));
}

}  // namespace

RowFilter::RowFilter(const InputConfig& config, const std::filesystem::path& file, const ScanReader& reader)
    : stride_(reader.layout().stride), bounds_(box_of(config.bounds)) {
  for (std::size_t at = 0; at < config.leave_out.size(); at += 6)
    boxes_.push_back(*box_of(std::span(config.leave_out).subspan(at, 6)));
  if (config.drop_origin) no_return_places_ = reader.no_return_places();
  const auto column_if_any = [&](const char* name) -> std::optional<Values> {
    const Property* const property = reader.layout().find_alike(name);
    return property == nullptr ? std::nullopt : std::optional(Values{.property = *property, .values = {}});
  };
  if (!config.keep_withheld) withheld_ = column_if_any("withheld");
  if (!config.keep_noise && reader.has_noise_classes()) class_ = column_if_any("classification");
  synthetic_ = column_if_any("synthetic");
  if (!config.where.empty()) where_.emplace(config.where, file.string(), reader.layout());
  is_active_ =
      config.drop_origin || bounds_ || !boxes_.empty() || withheld_ || class_ || synthetic_ || where_;
}

std::string describe_no_row_left(const InputConfig& config, const FilteredOut& filtered) {
  std::string text = "the filters leave none of the " + std::to_string(filtered.total()) + " points";
  const char* separator = ": ";
  const auto add = [&](const std::string& part) { text += std::exchange(separator, "; ") + part; };
  const auto add_option = [&](const std::string& option, std::uint64_t count) {
    add(option + " leaves out " + std::to_string(count));
  };
  if (config.drop_origin && filtered.origin > 0) add_option("--drop-origin", filtered.origin);
  if (!config.bounds.empty()) add_option("--bounds", filtered.bounds);
  if (const Eigen::AlignedBox3d& before = filtered.bounds_before; !config.bounds.empty() && !before.isEmpty())
    text += ", the scan lies from " + print_point(before.min()) + " to " + print_point(before.max());
  if (!config.leave_out.empty()) add_option("--leave-out", filtered.boxes);
  if (filtered.withheld > 0)
    add(std::to_string(filtered.withheld) + " are withheld, which --keep-withheld keeps");
  if (filtered.noise > 0) add(std::to_string(filtered.noise) + " are noise, which --keep-noise keeps");
  if (!config.where.empty()) add_option("--where", filtered.where);
  return text;
}

void RowFilter::apply(const RowBatch& rows, std::span<Eigen::Vector3d> positions, FilteredOut& filtered) {
  if (!is_active_) return;
  load(rows, withheld_);
  load(rows, class_);
  load(rows, synthetic_);
  if (where_) where_->load(rows);
  for (std::size_t row = 0; row < positions.size(); ++row) {
    Eigen::Vector3d& position = positions[row];
    if (!position.allFinite()) continue;
    std::uint64_t* const count = refusing(row, position, filtered);
    if (count == nullptr) {
      filtered.synthetic += synthetic_ && synthetic_->values[row] != 0;
      continue;
    }
    ++*count;
    position.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

// Returns the count of the first filter that refuses the row; null if none does.
std::uint64_t* RowFilter::refusing(std::size_t row, const Eigen::Vector3d& position,
                                   FilteredOut& filtered) const {
  constexpr double kLowNoise = 7, kHighNoise = 18;
  if (withheld_ && withheld_->values[row] != 0) return &filtered.withheld;
  if (class_ && (class_->values[row] == kLowNoise || class_->values[row] == kHighNoise))
    return &filtered.noise;
  if (std::count(no_return_places_.begin(), no_return_places_.end(), position) > 0) return &filtered.origin;
  if (bounds_) {
    filtered.bounds_before.extend(position);
    if (!bounds_->contains(position)) return &filtered.bounds;
  }
  if (std::any_of(boxes_.begin(), boxes_.end(), [&](const auto& box) { return box.contains(position); }))
    return &filtered.boxes;
  return where_ && !where_->holds(row) ? &filtered.where : nullptr;
}

void RowFilter::load(const RowBatch& rows, std::optional<Values>& column) const {
  if (!column) return;
  load_column(rows, stride_, column->property, column->values);
}

}  // namespace lacuna::io
