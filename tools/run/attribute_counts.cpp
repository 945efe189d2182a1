// SPDX-License-Identifier: Apache-2.0
#include "tools/run/attribute_counts.hpp"

#include "io/rows/vectors.hpp"
#include "tools/console/measures_text.hpp"

#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>
#include <vector>

namespace lacuna::tools {
namespace {

using namespace io;

std::string_view name_of_class(int number) {
  constexpr std::string_view kNames[] = {"never classified",
                                         "unclassified",
                                         "ground",
                                         "low vegetation",
                                         "medium vegetation",
                                         "high vegetation",
                                         "building",
                                         "low point",
                                         "",
                                         "water",
                                         "rail",
                                         "road",
                                         "",
                                         "wire guard",
                                         "wire conductor",
                                         "transmission tower",
                                         "wire connector",
                                         "bridge deck",
                                         "high noise"};
  const bool is_known = number >= 0 && number < std::ssize(kNames);
  return is_known ? kNames[number] : std::string_view();
}

}  // namespace

AttributeCounts count_attributes(ScanReader& reader, std::size_t rows_at_a_time) {
  AttributeCounts counts;
  const RowLayout& layout = reader.layout();
  const Property* const class_of = layout.find("classification");
  const Property* const number = layout.find("return_number");
  const Property* const number_of = layout.find("number_of_returns");
  counts.has_returns = number != nullptr && number_of != nullptr;
  std::vector<double> values, more;
  for (RowBatch rows; reader.next(rows, rows_at_a_time);) {
    counts.rows += rows.count;
    if (class_of != nullptr) {
      load_column(rows, layout.stride, *class_of, values);
      for (const double value : values) {
        if (std::abs(value) <= std::numeric_limits<int>::max()) ++counts.classes[static_cast<int>(value)];
      }
    }
    if (!counts.has_returns) continue;
    load_column(rows, layout.stride, *number, values);
    load_column(rows, layout.stride, *number_of, more);
    for (std::size_t i = 0; i < values.size(); ++i)
      ++(more[i] <= 1 ? counts.only : values[i] <= 1 ? counts.first : counts.later);
  }
  return counts;
}

std::string print_classes(const AttributeCounts& counts) {
  std::string text;
  for (const auto& [number, count] : counts.classes) {
    const std::string_view name = name_of_class(number);
    text += (text.empty() ? "" : " · ") + std::to_string(number) + (name.empty() ? "" : " ") +
            std::string(name) + " " + print_count(count);
  }
  return text;
}

std::string print_returns(const AttributeCounts& counts) {
  return print_count(counts.only) + " only, " + print_count(counts.first) + " first of several, " +
         print_count(counts.later) + " later";
}

}  // namespace lacuna::tools
