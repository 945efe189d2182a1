// SPDX-License-Identifier: Apache-2.0
#include "io/read/text/csv_writer.hpp"

#include "engine/run/parallel.hpp"
#include "engine/run/words.hpp"
#include "io/read/files/number.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

constexpr std::string_view kReplacement = "\xef\xbf\xbd";  // U+FFFD

bool is_plain(const std::string& name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const std::string lower = lower_case(name);
  const bool is_number = lower.starts_with("nan") || lower.starts_with("inf");
  return !name.empty() && is_letter(name.front()) && !is_number;
}

// Returns text that stays one cell, in UTF-8, and that no program takes for a formula.
std::string safe_name(std::string_view name) {
  constexpr std::string_view kFormulas = "=+-@";
  std::string safe;
  while (!name.empty()) {
    const std::size_t length = utf8_length(name);
    const std::string_view character = name.substr(0, std::max<std::size_t>(length, 1));
    if (length == 0) {
      safe += kReplacement;
    } else if (is_control(character) || character == "," || character == ";" || character == "\"") {
      safe += '_';
    } else {
      safe += character;
    }
    name.remove_prefix(character.size());
  }
  const std::size_t begin = safe.find_first_not_of(' ');
  const bool is_formula = begin != safe.npos && kFormulas.find(safe[begin]) != kFormulas.npos;
  return is_formula ? "_" + safe : safe;
}

std::vector<std::string> header_names(const RowLayout& layout) {
  std::vector<std::string> names;
  std::set<std::string> given;
  for (const Property& property : layout.properties) {
    const std::string name = safe_name(property.name);
    std::string unique = name;
    for (int i = 2; !given.insert(unique).second; ++i) unique = name + '_' + std::to_string(i);
    names.push_back(is_plain(unique) ? unique : '"' + unique + '"');
  }
  return names;
}

template <class T>
void append(std::string& text, T value) {
  if constexpr (!std::is_floating_point_v<T>) {
    text += std::to_string(value);
  } else if (std::isnan(value)) {
    text += "nan";  // whatever its sign
  } else {
    append_shortest(text, value);
  }
}

std::string lines_of(std::span<const std::byte> rows, const RowLayout& layout) {
  std::string text;
  for (; !rows.empty(); rows = rows.subspan(layout.stride)) {
    char separator = '\0';
    for (const Property& property : layout.properties) {
      if (std::exchange(separator, ',') != '\0') text += ',';
      with_type(property.type,
                [&](auto zero) { append(text, load<decltype(zero)>(&rows[property.offset])); });
    }
    text += '\n';
  }
  return text;
}

}  // namespace

CsvWriter::CsvWriter(OutputFile& out, RowLayout layout) : out_(out), layout_(std::move(layout)) {
  std::string line;
  for (const std::string& name : header_names(layout_)) line += (line.empty() ? "" : ",") + name;
  out_.write(line + '\n');
}

void CsvWriter::put_rows(std::span<const std::byte> rows) {
  constexpr std::size_t kTogether = 2048;
  const std::size_t count = rows.size() / layout_.stride;
  std::vector<std::string> texts((count + kTogether - 1) / kTogether);
  for_each_here(texts.size(), [&](std::size_t i) {
    const std::size_t first = i * kTogether, together = std::min(kTogether, count - first);
    texts[i] = lines_of(rows.subspan(first * layout_.stride, together * layout_.stride), layout_);
  });
  for (const std::string& text : texts) out_.write(text);
}

}  // namespace lacuna::io
