// SPDX-License-Identifier: Apache-2.0
#include "io/options/options.hpp"

#include "engine/run/error.hpp"
#include "tests/support/run_program.hpp"

#include <limits>
#include <set>

#include <catch2/catch.hpp>
#include <sys/stat.h>

namespace lacuna::io {
namespace {

using Catch::Matchers::Contains;
using test::ScratchFolder;

const Parameter& find(const std::vector<Parameter>& all, const std::string& key) {
  for (const Parameter& parameter : all) {
    if (parameter.key == key) return parameter;
  }
  throw std::runtime_error("no parameter " + key);
}

std::string error_of_set(const std::string& key, const std::string& text) {
  FilesConfig config;
  const std::vector<Parameter> all = parameters(config);
  try {
    find(all, key).set(text);
  } catch (const Error& error) {
    REQUIRE(print_config(config) == print_config(FilesConfig{}));
    return error.what();
  }
  return "";
}

// What is wrong with a file of this content; nothing of it may have been taken over.
std::string error_of_file(const std::string& content) {
  const ScratchFolder scratch;
  const std::string file = scratch.write("c.toml", content);
  FilesConfig config;
  try {
    read_config(file, config);
  } catch (const Error& error) {
    REQUIRE(print_config(config) == print_config(FilesConfig{}));
    const std::string text = error.what();
    REQUIRE(text.starts_with(file + ":"));
    return text.substr(file.size());
  }
  return "";
}

FilesConfig read(const std::string& content) {
  const ScratchFolder scratch;
  FilesConfig config;
  read_config(scratch.write("c.toml", content), config);
  return config;
}

TEST_CASE("text that the TOML library cannot take is an error with its line") {
  const std::string not_ascii = "a character outside of quotes that is not ASCII";
  CHECK_THAT(error_of_file("\xce\xa2"), Contains(":1: " + not_ascii));
  CHECK_THAT(error_of_file("[neighbourhood]\nk = 1\xce\xa2\n"), Contains(":2: " + not_ascii));
  CHECK_THAT(error_of_file("# ok\r\n\n\xc3\xa9 = 1"), Contains(":3: " + not_ascii));
  CHECK_THAT(error_of_file("[input]\ncolumns = \"x\" \xce\xa2"), Contains(":2: " + not_ascii));
  CHECK_THAT(error_of_file("[input]\ncolumns = '\\' \xce\xa2 # '"), Contains(":2: " + not_ascii));
  CHECK_THAT(error_of_file("[input]\ncolumns = \"\"\"\\\n\xce\xa2\"\"\""),
             Contains(":2: a string of several lines"));
  CHECK_THAT(error_of_file("[run]\nthreads = \v1"), Contains(":2: " + not_ascii));
  for (const std::string text : {"\xff", "# \xc3", "[input]\ncolumns = \"\xed\xa0\x80\"", "# \xc0\x9b"}) {
    CHECK_THAT(error_of_file(text), Contains("is not UTF-8"));
  }
  for (const std::string text : {"[=", "[", "[ \t", "[[", "[ .a]", "[\t= 1]", "[[ ,]]", " [#"}) {
    INFO(text);
    CHECK_THAT(error_of_file("\n" + text), Contains(":2: a section without a name"));
  }
}

TEST_CASE("comments and strings of a config file hold letters of any language") {
  const ScratchFolder scratch;
  FilesConfig config;
  read_config(scratch.write("c.toml",
                            "\xef\xbb\xbf# Gr\xc3\xb6\xc3\x9f"
                            "e '\"\r\n[ run ] # \xce\xa2\nworkspace = \"/\xce\xa2 \\\" # \" # \xce\xa2\n"
                            "['input']\n\"columns\" = '\xce\xa2 \\' # \xce\xa2"),
              config);
  CHECK(config.run.workspace == "/\xce\xa2 \" # ");
  CHECK(config.input.columns == "\xce\xa2 \\");
}

TEST_CASE("configs/default.toml is the printed default, byte for byte") {
  REQUIRE(test::read_file(LACUNA_SOURCE_DIR "/configs/default.toml") == print_config(FilesConfig{}));
}

TEST_CASE("every file in configs is read and possible, and each of its values has an effect") {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(LACUNA_SOURCE_DIR "/configs")) {
    FilesConfig config;
    read_config(entry.path(), config);
    check_config(config);
    FilesConfig defaults;
    const std::vector<Parameter> all = parameters(config), unchanged = parameters(defaults);
    for (std::size_t i = 0; i < all.size(); ++i) {
      INFO(entry.path() << ": " << all[i].key);
      CHECK((all[i].missing.empty() || all[i].print() == unchanged[i].print()));
    }
    const bool is_default = entry.path().filename() == "default.toml";
    CHECK((print_config(config) == print_config(FilesConfig{})) == is_default);
    ++files;
  }
  REQUIRE(files == 3);
}

TEST_CASE("a printed config reads back as itself, whatever its values") {
  FilesConfig config;
  config.neighbourhood.k = 1000;
  config.neighbourhood.eps = 0.1 + 0.2;
  config.criteria.sigma = 1e-7;
  config.normals.orient = true;
  config.input.columns = "x y \"z\" \\ \t \x01 \x7f \xc3\xa4";
  config.run.memory_limit = 1'500'000'001;
  config.run.workspace = "/tmp/with space";
  const std::string printed = print_config(config);
  const FilesConfig again = read(printed);
  REQUIRE(print_config(again) == printed);
  CHECK(again.neighbourhood.eps == 0.1 + 0.2);
  CHECK(again.input.columns == config.input.columns);
  CHECK(again.run.memory_limit == 1'500'000'001);
}

TEST_CASE("every key is unique and gives its option") {
  FilesConfig config;
  std::set<std::string> options;
  for (const Parameter& parameter : parameters(config)) {
    CHECK(options.insert(parameter.option()).second);
    CHECK_FALSE(parameter.help.empty());
  }
  CHECK(options.count("--orient-normals") == 1);
  CHECK(options.count("--tile-points") == 1);
  CHECK(options.count("--points") == 1);
  CHECK(options.count("--points-normals") == 1);
}

TEST_CASE("the least and the largest value of each number are possible, the next ones are not") {
  FilesConfig config;
  for (const Parameter& parameter : parameters(config)) {
    INFO(parameter.key);
    if (const auto* number = std::get_if<double*>(&parameter.value)) {
      **number = parameter.max;
      const std::string largest = parameter.print();
      CHECK_NOTHROW(parameter.set(largest));
      CHECK_THROWS_AS(parameter.set("-1"), Error);
      CHECK_THROWS_AS(parameter.set("1e301"), Error);
    } else if (std::holds_alternative<std::int64_t*>(parameter.value)) {
      const auto most = static_cast<std::int64_t>(parameter.max);
      const auto least = static_cast<std::int64_t>(parameter.min);
      CHECK_NOTHROW(parameter.set(std::to_string(least)));
      CHECK_NOTHROW(parameter.set(std::to_string(most)));
      CHECK_THROWS_AS(parameter.set(std::to_string(least - 1)), Error);
      CHECK_THROWS_AS(parameter.set(std::to_string(most + 1)), Error);
    }
  }
}

TEST_CASE("an impossible value names its key and what is allowed") {
  CHECK(error_of_set("k", "0") == "k = 0 is not possible; allowed: a whole number from 1 to 1000");
  for (const char* text : {"", " ", "15.5", "15x", "0x10", "99999999999999999999", "nan"}) {
    CHECK_THAT(error_of_set("k", text), Contains("allowed: a whole number"));
  }
  for (const char* text : {"nan", "inf", "-inf", "-0.1", "1e999", "", "1,5"}) {
    CHECK_THAT(error_of_set("eps", text), Contains("eps = "));
  }
  CHECK_THAT(error_of_set("sigma", "0"), Contains("a number above 0"));
  CHECK_THAT(error_of_set("cone", "90"), Contains("less than 90"));
  CHECK_THAT(error_of_set("orient_normals", "yes"), Contains("true or false"));
  CHECK_THAT(error_of_set("memory_limit", "63MiB"), Contains("at least 64MiB"));
  CHECK_THAT(error_of_set("memory_limit", "plenty"), Contains("memory_limit = plenty"));
  CHECK(error_of_set("memory_limit", "64MiB").empty());
  CHECK(error_of_set("memory_limit", "0").empty());
}

TEST_CASE("a memory limit that is too little for a report or for GDAL is refused") {
  FilesConfig config;
  config.run.memory_limit = 64 << 20;
  CHECK_NOTHROW(check_config(config));
  config.output.report = true;
  CHECK_THROWS_WITH(check_config(config),
                    "memory_limit = 64MiB is too little for a report; allowed: at least 96MiB");
  config.output.gpkg = true;
  CHECK_THROWS_WITH(
      check_config(config),
      "memory_limit = 64MiB is too little for a report and files for GIS; allowed: at least 144MiB");
  config.run.memory_limit = 144 << 20;
  CHECK_NOTHROW(check_config(config));
}

TEST_CASE("lists of numbers come as text with commas and as arrays, and print as arrays") {
  FilesConfig config;
  const std::vector<Parameter> all = parameters(config);
  find(all, "bounds").set("-1, 2.5,3 4");
  CHECK(config.input.bounds == std::vector{-1.0, 2.5, 3.0, 4.0});
  CHECK(find(all, "bounds").print() == "[-1.0, 2.5, 3.0, 4.0]");
  CHECK_THAT(error_of_set("bounds", "1,nan,3,4"), Contains("bounds = 1,nan,3,4"));
  CHECK(read("[input]\nbounds = [1, 2.5, 3, 4]\n").input.bounds == std::vector{1.0, 2.5, 3.0, 4.0});
  CHECK_THAT(error_of_file("[input]\nbounds = 2\n"), Contains(":2: bounds = 2 is not"));
  CHECK_THAT(error_of_set("trust", "both"), Contains("allowed: neither, header or file"));
}

TEST_CASE("bounds of another count of numbers, or without content, contradict themselves") {
  const auto error = [](std::vector<double> bounds) {
    FilesConfig config;
    config.input.bounds = std::move(bounds);
    try {
      check_config(config);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(error({}).empty());
  CHECK(error({0, 0, 1, 1}).empty());
  CHECK(error({0, 0, 0, 0, 0, 0}).empty());
  CHECK_THAT(error({0, 0, 1}), Contains("bounds has 3 numbers; allowed: 4"));
  CHECK_THAT(error({0, 1, 0, 5, 6, -1}), Contains("min z = 0.0 is above max z = -1.0"));
}

TEST_CASE("the former name of a method is refused with its present one") {
  CHECK(error_of_set("method", "stars") ==
        "method = stars (now called tangential) is not possible; allowed: tangential or paper");
  CHECK_THAT(error_of_file("[loops]\nmethod = \"stars\"\n"), Contains(":2: ") && Contains("tangential"));
  CHECK_THAT(error_of_set("method", "star"), Contains("method = star is not"));
}

TEST_CASE("an impossible value in a file is an error with its line") {
  CHECK(error_of_file("[neighbourhood]\n\nk = 0\n") ==
        ":3: k = 0 is not possible; allowed: a whole number from 1 to 1000");
  CHECK_THAT(error_of_file("[neighbourhood]\nk = 15.0\n"), Contains(":2: k = 15.0"));
  CHECK_THAT(error_of_file("[neighbourhood]\nk = \"15\"\n"), Contains("k = \"15\""));
  CHECK_THAT(error_of_file("[neighbourhood]\nk = [15]\n"), Contains("k = "));
  CHECK_THAT(error_of_file("[neighbourhood]\neps = nan\n"), Contains("eps = nan"));
  CHECK_THAT(error_of_file("[neighbourhood]\neps = inf\n"), Contains("eps = inf"));
  CHECK_THAT(error_of_file("[neighbourhood]\neps = true\n"), Contains("eps = true"));
  CHECK_THAT(error_of_file("[output]\npoints = 1\n"), Contains("true or false"));
  CHECK_THAT(error_of_file("[run]\nmemory_limit = 1.5\n"), Contains("memory_limit = 1.5"));
  CHECK_THAT(error_of_file("[run]\nmemory_limit = -1\n"), Contains("memory_limit = -1"));
  CHECK_THAT(error_of_file("[run]\nworkspace = 3\n"), Contains("the name of a folder"));
}

TEST_CASE("a whole number is a number, and a size may be one") {
  const FilesConfig config = read("[neighbourhood]\neps = 2\n[run]\nmemory_limit = 4000000000\n");
  CHECK(config.neighbourhood.eps == 2.0);
  CHECK(config.run.memory_limit == 4'000'000'000);
}

TEST_CASE("an unknown key names its line and the keys allowed there") {
  CHECK(error_of_file("[neighbourhood]\nk = 3\nespilon = 1\n") ==
        ":3: unknown key \"espilon\" in [neighbourhood]; allowed there: k, eps, eps_fraction");
  CHECK_THAT(error_of_file("[neighbourhood]\neps_fracton = 1\n"), Contains("did you mean \"eps_fraction\"?"));
  CHECK_THAT(error_of_file("[neighbourhood]\nsigma = 1\n"), Contains("\"sigma\" belongs in [criteria]"));
  CHECK_THAT(error_of_file("[neigbourhood]\nk = 1\n"),
             Contains("unknown section \"neigbourhood\" (did you mean \"neighbourhood\"?)"));
  CHECK_THAT(error_of_file("k = 1\n"), Contains("outside of a section (\"k\" belongs in [neighbourhood])"));
  CHECK_THAT(error_of_file("[[neighbourhood]]\nk = 1\n"), Contains("neighbourhood"));
}

TEST_CASE("what is not TOML is an error with its line") {
  CHECK_THAT(error_of_file("[neighbourhood]\nk = \n"), Contains(":2: "));
  CHECK_THAT(error_of_file("[run]\nthreads = 1\nthreads = 2\n"), Contains(":3: "));
  CHECK_THAT(error_of_file("\xff\xfe"), Contains(":1: "));
}

TEST_CASE("every prefix of the default config is read or refused, never more") {
  const ScratchFolder scratch;
  const std::string whole = print_config(FilesConfig{});
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    FilesConfig config;
    try {
      read_config(scratch.write("c.toml", whole.substr(0, length)), config);
    } catch (const Error& error) {
      CHECK_THAT(error.what(), Contains("c.toml:"));
    }
  }
}

TEST_CASE("a config file that cannot be read is named") {
  const ScratchFolder scratch;
  FilesConfig config;
  REQUIRE_THROWS_WITH(read_config(scratch / "none.toml", config), Contains("none.toml: cannot be opened"));
  REQUIRE_THROWS_WITH(read_config(scratch / ".", config), Contains("a folder"));
  REQUIRE_THROWS_WITH(read_config("/dev/zero", config), Contains("not a regular file"));
  REQUIRE(mkfifo((scratch / "pipe").c_str(), 0600) == 0);
  REQUIRE_THROWS_WITH(read_config(scratch / "pipe", config),
                      Contains("pipe: is not a regular file; a config file is needed"));
  const std::string large = scratch.write("large.toml", std::string((1 << 20) + 1, '#'));
  REQUIRE_THROWS_WITH(read_config(large, config), Contains("too large"));
}

TEST_CASE("a name of thousands of parts in a config file is refused with its line") {
  std::string name = "a";
  for (int i = 0; i < 100'000; ++i) name += i % 2 == 0 ? ".a" : " . \"a\"";
  for (const std::string& text : {"[" + name + "]", "[[" + name + "]]", name + " = 1",
                                  "a = {" + name + " = 1}", "a = [\n{b = 1, " + name + " = 1}]"}) {
    INFO(text.substr(0, 20));
    CHECK_THAT(error_of_file("# Parts.\n" + text), Contains("a name of more than 16 parts"));
  }
  FilesConfig config;
  const ScratchFolder scratch;
  read_config(scratch.write("c.toml", "[input]\nbounds = [1.5, 2.5, 3.5, 4.5, 5.5, 6.5]  # " + name), config);
  CHECK(config.input.bounds.size() == 6);
}

TEST_CASE("values that contradict each other are refused") {
  FilesConfig config;
  REQUIRE_NOTHROW(check_config(config));
  config.neighbourhood = {.eps = 1, .eps_fraction = 0.1};
  REQUIRE_THROWS_WITH(check_config(config), Contains("eps and eps_fraction"));
  config = {};
  config.criteria.weights = {0, 0, 0};
  REQUIRE_THROWS_WITH(check_config(config),
                      Contains("weight_angle, weight_halfdisc and weight_shape are all 0"));
  config.criteria.weights = {1, 1};
  REQUIRE_THROWS_WITH(check_config(config), Contains("2 weights of criteria; allowed: 3"));
  config = {};
  config.selection = {.min_perimeter = 2, .max_perimeter = 1};
  REQUIRE_THROWS_WITH(check_config(config), Contains("max_perimeter"));
  config = {};
  config.selection = {.min_area = 2, .max_area = 1};
  REQUIRE_THROWS_WITH(check_config(config), Contains("max_area = 1.0 is less than min_area = 2.0"));
  config = {};
  config.criteria.sigma = std::numeric_limits<double>::quiet_NaN();
  REQUIRE_THROWS_WITH(check_config(config), Contains("sigma = nan"));
  config = {};
  config.run.memory_limit = 1;
  REQUIRE_THROWS_WITH(check_config(config), Contains("memory_limit"));
}

TEST_CASE("a size has a unit or none") {
  CHECK(parse_bytes("0") == 0);
  CHECK(parse_bytes("1500000") == 1'500'000);
  CHECK(parse_bytes("512MiB") == 512ull << 20);
  CHECK(parse_bytes("2 GiB") == 2ull << 30);
  CHECK(parse_bytes("3TiB") == 3ull << 40);
  CHECK(parse_bytes("7KiB") == 7 * 1024);
  CHECK(parse_bytes("2GB") == 2'000'000'000);
  for (const char* text : {"", "MiB", "-1", "1.5GiB", "1e9", "5 XiB", "5  MiB", "20000000TiB", "0x10"}) {
    INFO(text);
    CHECK_FALSE(parse_bytes(text));
  }
}

TEST_CASE("a printed size is exact and reads back") {
  CHECK(print_bytes(0) == "0");
  CHECK(print_bytes(512ull << 20) == "512MiB");
  CHECK(print_bytes(1ull << 30) == "1GiB");
  CHECK(print_bytes(1536ull << 20) == "1536MiB");
  CHECK(print_bytes(1'500'000) == "1500000");
  for (const std::uint64_t bytes : {1ull, 1023ull, 1024ull, 1ull << 40, ~0ull}) {
    CHECK(parse_bytes(print_bytes(bytes)) == bytes);
  }
}

}  // namespace
}  // namespace lacuna::io
