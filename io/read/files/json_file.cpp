// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/json_file.hpp"

#include "engine/run/error.hpp"
#include "engine/run/machine.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

namespace lacuna::io {
namespace {

using Event = Json::parse_event_t;

// The text of a file. The parser holds one token at a time, however long it is.
class Text final : public std::filebuf {
 public:
  explicit Text(const std::filesystem::path& file) { open(file, std::ios::in | std::ios::binary); }

  void begin_token() { blocks_ = 0; }
  bool is_too_long() const { return blocks_ > kMostBlocks; }

 private:
  static constexpr std::size_t kMostBlocks = (std::size_t{1} << 20) / BUFSIZ;

  int_type underflow() override {
    return ++blocks_ > kMostBlocks ? traits_type::eof() : std::filebuf::underflow();
  }
  std::size_t blocks_ = 0;
};

// What is kept of the values at each level.
class Kept {
 public:
  static constexpr int kDeepest = 32;

  // Whether the parts of this event are left out because the whole is.
  bool is_within_left_out(int depth, Event event) {
    const bool is_within = depth > left_out_ || (depth == left_out_ && is_key_ && event != Event::key);
    if (!is_within) left_out_ = kNone;
    return is_within;
  }
  // Whether the values are within the bounds.
  bool take(int depth, Event event, const Json& parsed, bool is_kept) {
    constexpr std::size_t kMost = std::size_t{1} << 22, kBytesOfValue = 64;
    std::size_t& before = before_[static_cast<std::size_t>(depth)];
    const bool is_start = event == Event::object_start || event == Event::array_start;
    if (is_start) before = values_;
    if ((is_start || event == Event::key) && !is_kept) {
      left_out_ = depth;
      is_key_ = event == Event::key;
    } else if (!is_kept && event != Event::value) {
      values_ = before;
    }
    const std::size_t bytes = parsed.is_string() ? parsed.get_ref<const std::string&>().size() : 0;
    if (is_kept) values_ += 1 + bytes / kBytesOfValue;
    return values_ <= kMost;
  }

 private:
  static constexpr int kNone = kDeepest + 1;

  std::size_t values_ = 0;
  std::array<std::size_t, kDeepest + 1> before_{};  // of each object or list that is open
  int left_out_ = kNone;                            // depth of the key, object or list
  bool is_key_ = false;
};

}  // namespace

Json read_json(const std::filesystem::path& file, std::string_view needed,
               const Json::parser_callback_t& keep) {
  check_regular_file(file, needed);
  Text text(file);
  if (!text.is_open()) throw Error(file.string() + ": cannot be opened: " + std::strerror(errno));
  const auto fail = [&](const std::string& reason) {
    throw Error(file.string() + ": " + reason + "; " + std::string(needed) + " is needed");
  };
  Kept kept;
  const auto take = [&](int depth, Event event, Json& parsed) {
    text.begin_token();
    // Printing and copying nested values is recursive.
    if (depth > Kept::kDeepest) fail("is nested deeper than " + std::to_string(Kept::kDeepest) + " levels");
    const bool is_wanted = !keep || keep(depth, event, parsed);
    if (kept.is_within_left_out(depth, event)) return false;
    if (!kept.take(depth, event, parsed, is_wanted)) fail("has more values than the 4 million that are read");
    return is_wanted;
  };
  try {
    std::istream in(&text);
    return Json::parse(in, take);
  } catch (const Json::parse_error& error) {
    if (text.is_too_long()) fail("byte " + std::to_string(error.byte) + ": a value of more than 1 MiB");
    fail("byte " + std::to_string(error.byte) + ": is not JSON");
  } catch (const Json::out_of_range& error) {
    constexpr int kTooLarge = 406;
    if (error.id != kTooLarge) throw;  // of the caller
    fail(text.is_too_long() ? "a value of more than 1 MiB" : "has a number beyond those of double precision");
  }
  return {};
}

}  // namespace lacuna::io
