// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/json_file.hpp"

#include "tests/io/io_support.hpp"

#include <sys/stat.h>

namespace lacuna::io {
namespace {

using Event = Json::parse_event_t;

std::string error_of(const std::string& text, const Json::parser_callback_t& keep = {}) {
  const ScratchFolder folder;
  return test::error_of([&] { read_json(folder.write("a.json", text), "a result", keep); });
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

TEST_CASE("JSON that could take any memory is an error of one line", "[io]") {
  CHECK_THAT(error_of("[1, 2"), Contains("a.json: byte 6: is not JSON; a result is needed"));
  CHECK_THAT(error_of(std::string(100'000, '[')), Contains("is nested deeper than 32 levels"));
  const auto drop_a = [](int, Event event, const Json& parsed) {
    return event != Event::key || parsed != "a";
  };
  CHECK_THAT(error_of("{\"a\": " + std::string(100'000, '['), drop_a), Contains("is nested deeper than 32"));
  CHECK_THAT(error_of("{\"a\": \"" + std::string(3 << 20, 'x') + "\"}"),
             Contains("a value of more than 1 MiB"));
  CHECK_THAT(error_of("[" + std::string(3 << 20, '7') + "]"), Contains("a value of more than 1 MiB"));
  CHECK_THAT(error_of("[1e999]"), Contains("beyond those of double precision"));
  CHECK_THAT(error_of("[0" + repeated(",0", 5'000'000) + "]"), Contains("more values than the 4 million"));
  CHECK(error_of("[" + std::string(900'000, ' ') + "]").empty());
  const ScratchFolder folder;
  const auto pipe = folder / "pipe.json";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THAT(test::error_of([&] { read_json(pipe, "a result"); }),
             Contains("is not a regular file; a result is needed"));
}

TEST_CASE("what is left out of JSON does not count, however much it is", "[io]") {
  const std::string text =
      R"({"a": [[0)" + repeated(",[0]", 2'000'000) + R"(]], "b": {"c": [[1], [2]]}, "d": 3})";
  const auto keep = [](int, Event event, const Json& parsed) { return event != Event::key || parsed != "a"; };
  const ScratchFolder folder;
  const fs::path file = folder.write("a.json", text);
  CHECK(read_json(file, "a result", keep) == Json::parse(R"({"b": {"c": [[1], [2]]}, "d": 3})"));
  const auto keep_flat = [](int depth, Event event, const Json&) {
    return depth != 2 || event != Event::array_end;
  };
  const fs::path lists = folder.write("b.json", "[[0" + repeated(",[0]", 5'000'000) + "]]");
  CHECK(read_json(lists, "a result", keep_flat) == Json::parse("[[0]]"));
}

}  // namespace
}  // namespace lacuna::io
