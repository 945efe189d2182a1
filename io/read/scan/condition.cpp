// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/condition.hpp"

#include "engine/run/error.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/scan_reader.hpp"

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

}  // namespace lacuna::io
