// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loops_reader.hpp"

#include "engine/run/error.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/ply/ply_reader.hpp"
#include "io/read/rows/columns.hpp"

#include <utility>

namespace lacuna::evaluation {
using namespace io;

namespace {

constexpr double kIdsEnd = 0x1p53;  // from here on a double is no longer any whole number
constexpr std::size_t kLongestComment = 200;

// A column of whole numbers from 0 on, whatever its type.
std::vector<std::uint64_t> read_column(const std::filesystem::path& file, std::string_view name) {
  const auto reader = open_ply(file, {});
  const Property* property = reader->layout().find(name);
  if (!property) {
    throw Error(file.string() + ": element 'vertex' has no property " + in_quotes(name) +
                "; files as lacuna detect writes them have it");
  }
  constexpr std::size_t kRowsAtATime = 1 << 16;
  std::vector<std::uint64_t> column;
  std::vector<double> values;
  for (RowBatch batch; reader->next(batch, kRowsAtATime);) {
    load_column(batch, reader->layout().stride, *property, values);
    for (const double value : values) {
      const bool whole =
          value >= 0 && value < kIdsEnd && value == static_cast<double>(static_cast<std::uint64_t>(value));
      if (!whole) {
        throw Error(file.string() + ": vertex " + std::to_string(column.size()) + " (from 0): '" +
                    std::string(name) + "' is " + std::to_string(value) +
                    "; a whole number from 0 on is needed");
      }
      column.push_back(static_cast<std::uint64_t>(value));
    }
  }
  return column;
}

std::vector<NamedLoopIds> read_ply_loops(const std::filesystem::path& file) {
  const std::vector<std::uint64_t> ids = read_column(file, "scalar_id");
  const std::vector<std::uint64_t> loop_of = read_column(file, "scalar_loop");
  std::vector<NamedLoopIds> loops;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const bool known = loop_of[i] + 1 == loops.size();
    if (!known && loop_of[i] != loops.size()) {
      throw Error(file.string() + ": vertex " + std::to_string(i) + " (from 0): loop " +
                  std::to_string(loop_of[i]) + " where " + std::to_string(loops.size()) +
                  " would be the next; loops must follow one after the other from 0 on");
    }
    if (!known) loops.emplace_back();
    loops.back().ids.push_back(ids[i]);
  }
  return loops;
}

// Returns the remainder of a comment's line, its words divided by one blank.
std::string read_comment(InputFile& in, std::string_view first) {
  std::string text(first);
  while (const auto word = in.next_word()) {
    if (text.size() + 1 + word->size() > kLongestComment) break;
    text.append(" ").append(*word);
  }
  return text;
}

// Returns "window" for "# window". The mark of the file is no name, and a marked row is none.
std::string name_in(std::string comment) {
  if (comment.starts_with(kLoopsTextMark)) return {};
  for (const std::string_view mark : {kStepMark, kNarrowMark})
    if (comment.starts_with(std::string(mark) + " ")) return {};
  comment.erase(0, comment.find_first_not_of("# "));
  return comment;
}

std::uint64_t parse_id(const InputFile& in, std::string_view word) {
  std::uint64_t id = 0;
  if (!parse_number(word, id)) {
    in.fail_at_line(in.line() + 1, in_quotes(word) + " is not a point id, " +
                                       describe_number<std::uint64_t>() + "; a line is the ids of one loop");
  }
  return id;
}

std::vector<NamedLoopIds> read_text_loops(InputFile& in) {
  std::vector<NamedLoopIds> loops;
  std::string name;
  while (in.next_row()) {
    LoopIds loop;
    while (const auto word = in.next_word()) {
      if (word->starts_with('#') && loop.empty()) {
        name = word->size() <= kLongestComment ? name_in(read_comment(in, std::string(*word))) : "";
        break;
      }
      loop.push_back(parse_id(in, *word));
    }
    while (!in.end_row()) in.next_word();  // the rest of a comment
    if (!loop.empty()) loops.push_back({std::move(loop), std::exchange(name, "")});
  }
  return loops;
}

}  // namespace

std::vector<NamedLoopIds> read_named_loops(const std::filesystem::path& file) {
  InputFile in(file);
  if (looks_like_ply({.first_bytes = in.peek(4), .size = in.remaining()})) return read_ply_loops(file);
  return read_text_loops(in);
}

std::vector<LoopIds> read_loops(const std::filesystem::path& file) {
  std::vector<LoopIds> loops;
  for (NamedLoopIds& loop : read_named_loops(file)) loops.push_back(std::move(loop.ids));
  return loops;
}

std::vector<LoopIds> read_marked(const std::filesystem::path& file, std::string_view mark) {
  std::vector<LoopIds> rows;
  InputFile in(file);
  if (looks_like_ply({.first_bytes = in.peek(4), .size = in.remaining()})) return rows;
  while (in.next_row()) {
    if (const auto word = in.next_word(); word && *word == mark) {
      LoopIds& row = rows.emplace_back();
      while (const auto id = in.next_word()) row.push_back(parse_id(in, *id));
    }
    while (!in.end_row()) in.next_word();
  }
  return rows;
}

std::vector<std::uint64_t> read_ids(const std::filesystem::path& file) {
  return read_column(file, "scalar_id");
}

}  // namespace lacuna::evaluation
