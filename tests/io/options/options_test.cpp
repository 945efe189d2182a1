// SPDX-License-Identifier: Apache-2.0
#include "io/read/options/options.hpp"

#include "tests/io/io_support.hpp"

#include <sys/stat.h>

namespace lacuna::io {
namespace {

const Parameter& find(const std::vector<Parameter>& all, const std::string& key) {
  for (const Parameter& parameter : all)
    if (parameter.key == key) return parameter;
  throw std::runtime_error("no parameter " + key);
}

std::string error_of_set(const std::string& key, const std::string& text) {
  FilesConfig config;
  const std::vector<Parameter> all = parameters(config);
  const std::string error = test::error_of([&] { find(all, key).set(text); });
  if (!error.empty()) REQUIRE(print_config(config) == print_config(FilesConfig{}));
  return error;
}

// What is wrong with a file of this content; nothing of it may have been taken over.
std::string error_of_file(const std::string& content) {
  const ScratchFolder scratch;
  const std::string file = scratch.write("c.toml", content);
  FilesConfig config;
  const std::string error = test::error_of([&] { read_config(file, config); });
  if (error.empty()) return error;
  REQUIRE(print_config(config) == print_config(FilesConfig{}));
  REQUIRE(error.starts_with(file + ":"));
  return error.substr(file.size());
}

FilesConfig read(const std::string& content) {
  const ScratchFolder scratch;
  FilesConfig config;
  read_config(scratch.write("c.toml", content), config);
  return config;
}

TEST_CASE("text that the TOML library cannot take is an error with its line") {
  const std::string not_ascii = "a character outside of quotes that is not ASCII";
  std::string name = "a";  // of thousands of parts
  for (int i = 0; i < 100'000; ++i) name += i % 2 == 0 ? ".a" : " . \"a\"";
  std::vector<test::Wrong> cases = {
      {"\xce\xa2", ":1: " + not_ascii},
      {"[neighbourhood]\nk = 1\xce\xa2\n", ":2: " + not_ascii},
      {"# ok\r\n\n\xc3\xa9 = 1", ":3: " + not_ascii},
      {"[input]\ncolumns = \"x\" \xce\xa2", ":2: " + not_ascii},
      {"[input]\ncolumns = '\\' \xce\xa2 # '", ":2: " + not_ascii},
      {"[input]\ncolumns = \"\"\"\\\n\xce\xa2\"\"\"", ":2: a string of several"},
      {"[run]\nthreads = \v1", ":2: " + not_ascii},
      {"[neighbourhood]\nk = \n", ":2: "},
      {"[run]\nthreads = 1\nthreads = 2\n", ":3: "},
      {"\xff\xfe", ":1: "}};
  for (const std::string text : {"\xff", "# \xc3", "[input]\ncolumns = \"\xed\xa0\x80\"", "# \xc0\x9b"})
    cases.push_back({text, "is not UTF-8"});
  for (const std::string text : {"[=", "[", "[ \t", "[[", "[ .a]", "[\t= 1]", "[[ ,]]", " [#"})
    cases.push_back({"\n" + text, ":2: a section without a name"});
  for (const std::string& text : {"[" + name + "]", "[[" + name + "]]", name + " = 1",
                                  "a = {" + name + " = 1}", "a = [\n{b = 1, " + name + " = 1}]"})
    cases.push_back({"# Parts.\n" + text, "a name of more than 16 parts"});
  test::check_reasons(cases, error_of_file);
  CHECK(read("[input]\nbounds = [1, 2, 3, 4, 5, 6]  # " + name).input.bounds.size() == 6);
}

TEST_CASE("comments and strings of a config file hold letters of any language") {
  const FilesConfig config = read(
      "\xef\xbb\xbf# Größe '\"\r\n[ run ] # \xce\xa2\nworkspace = \"/\xce\xa2 \\\" # \" # \xce\xa2\n"
      "['input']\n\"columns\" = '\xce\xa2 \\' # \xce\xa2");
  CHECK(config.run.workspace == "/\xce\xa2 \" # ");
  CHECK(config.input.columns == "\xce\xa2 \\");
}

TEST_CASE("configs/default.toml is the printed default, byte for byte") {
  REQUIRE(test::read_file(LACUNA_SOURCE_DIR "/configs/default.toml") == print_config(FilesConfig{}));
}

TEST_CASE("the engine's config knows no parameter of files") {
  const ScratchFolder scratch;
  Config config;
  CHECK_THROWS_WITH(read_config(scratch.write("c.toml", "[output]\nreport = true\n"), config),
                    Contains(":2: unknown key \"report\" in [output]; allowed there: points, sample_points"));
}

TEST_CASE("constants of both methods are for the config file alone, which says so") {
  FilesConfig config;
  const std::set<std::string_view> sections = {"criteria", "coherence", "spanning", "tangential"};
  for (const Parameter& parameter : parameters(config))
    CHECK(parameter.in_file_only == (sections.contains(parameter.section) ||
                                     parameter.key == "eps_fraction" || parameter.key == "crease_threshold"));
  CHECK_THAT(print_config(config),
             Contains("[coherence]\n# Not for ordinary use: no option of the command line sets it.\n"));
}

TEST_CASE("every file in configs is read and possible, and each of its values has an effect") {
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(LACUNA_SOURCE_DIR "/configs")) {
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
  for (const char c : printed) CHECK((c == '\n' || (c >= ' ' && c != '\x7f') || c < 0));
  const FilesConfig again = read(printed);
  REQUIRE(print_config(again) == printed);
  CHECK(again.neighbourhood.eps == 0.1 + 0.2);
  CHECK(again.input.columns == config.input.columns);
  CHECK(again.run.memory_limit == 1'500'000'001);
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
  const auto check = [](const std::string& key, const std::vector<std::string>& texts,
                        const std::string& part) {
    for (const std::string& text : texts)
      CHECK_THAT(error_of_set(key, text), Contains(key + " = ") && Contains(part));
  };
  CHECK(error_of_set("k", "0") == "k = 0 is not possible; allowed: a whole number from 1 to 1000");
  check("k", {"", " ", "15.5", "15x", "0x10", "99999999999999999999", "nan"}, "allowed: a whole number");
  check("eps", {"nan", "inf", "-inf", "-0.1", "1e999", "", "1,5"}, "not possible");
  check("sigma", {"0"}, "a number above 0");
  check("cone", {"90"}, "less than 90");
  check("orient_normals", {"yes"}, "true or false");
  check("memory_limit", {"63MiB"}, "at least 64MiB");
  check("memory_limit", {"plenty"}, "memory_limit = plenty");
  check("bounds", {"1,nan,3,4"}, "bounds = 1,nan,3,4");
  check("trust", {"both"}, "allowed: neither, header or file");
  check("method", {"star"}, "method = star is not possible; allowed: tangential or paper");
  for (const char* bytes : {"64MiB", "0"}) CHECK(error_of_set("memory_limit", bytes).empty());
}

TEST_CASE("a memory limit that is too little for a report or for GDAL is refused") {
  FilesConfig config;
  config.run.memory_limit = 64 << 20;
  CHECK_NOTHROW(check_config(config));
  config.output.report = true;
  CHECK_THROWS_WITH(check_config(config), Contains("for a report; allowed: at least 96MiB"));
  config.output.gpkg = true;
  CHECK_THROWS_WITH(check_config(config), Contains("a report and files for GIS; allowed: at least 144MiB"));
  config.run.memory_limit = 144 << 20;
  CHECK_NOTHROW(check_config(config));
}

TEST_CASE("an impossible value or an unknown key in a file is an error with its line") {
  const std::string first = "[neighbourhood]\n";
  test::check_reasons({{first + "\nk = 0\n", ":3: k = 0 is not possible; allowed: a whole number from 1"},
                       {first + "k = 15.0\n", ":2: k = 15.0"},
                       {first + "k = \"15\"\n", "k = \"15\""},
                       {first + "k = [15]\n", "k = "},
                       {first + "eps = nan\n", "eps = nan"},
                       {first + "eps = inf\n", "eps = inf"},
                       {first + "eps = true\n", "eps = true"},
                       {"[input]\nbounds = 2\n", ":2: bounds = 2 is not"},
                       {"[loops]\nmethod = \"stars\"\n", ":2: method = stars is not possible"},
                       {"[output]\npoints = 1\n", "true or false"},
                       {"[run]\nmemory_limit = 1.5\n", "memory_limit = 1.5"},
                       {"[run]\nmemory_limit = -1\n", "memory_limit = -1"},
                       {"[run]\nworkspace = 3\n", "the name of a folder"},
                       {first + "k = 3\nespilon = 1\n", ":3: unknown key \"espilon\" in [neighbourhood]"},
                       {first + "espilon = 1\n", "allowed there: k, eps, eps_fraction"},
                       {first + "eps_fracton = 1\n", "did you mean \"eps_fraction\"?"},
                       {first + "sigma = 1\n", "\"sigma\" belongs in [criteria]"},
                       {"[neigbourhood]\nk = 1\n", "unknown section \"neigbourhood\" (did you mean"},
                       {"k = 1\n", "outside of a section (\"k\" belongs in [neighbourhood])"},
                       {"[[neighbourhood]]\nk = 1\n", "neighbourhood"}},
                      error_of_file);
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

TEST_CASE("values that contradict each other are refused") {
  const auto refused = [](const auto& change, const std::string& part) {
    FilesConfig config;
    change(config);
    CHECK_THROWS_WITH(check_config(config), Contains(part));
  };
  using Changed = FilesConfig&;
  refused([](Changed c) { c.neighbourhood = {.eps = 1, .eps_fraction = 0.1}; }, "eps and eps_fraction");
  refused([](Changed c) { c.criteria.weights = {0, 0, 0}; }, "weight_halfdisc and weight_shape are all 0");
  refused([](Changed c) { c.criteria.weights = {1, 1}; }, "2 weights of criteria; allowed: 3");
  refused([](Changed c) { c.criteria.sigma = std::nan(""); }, "sigma = nan");
  refused([](Changed c) { c.run.memory_limit = 1; }, "memory_limit");
  refused([](Changed c) { c.input.bounds = {0, 0, 1}; }, "bounds has 3 numbers; allowed: 4");
  refused([](Changed c) { c.input.bounds = {0, 1, 0, 5, 6, -1}; }, "min z = 0.0 is above max z = -1.0");
  for (const std::vector<double>& bounds : {std::vector<double>{}, {0, 0, 1, 1}, std::vector<double>(6, 0)}) {
    FilesConfig config;
    config.input.bounds = bounds;
    CHECK_NOTHROW(check_config(config));
  }
}

TEST_CASE("the least void is a length, or so many spacings, with a unit or without one") {
  const auto size = [](const std::string& rule) {
    const VoidSize found = void_size_of({.void_rule = rule});
    return std::pair(found.length, std::string(found.unit));
  };
  CHECK(size("2.5") == std::pair(2.5, std::string()));
  CHECK(size("2.5 us-ft") == std::pair(2.5, std::string("us-ft")));
  CHECK(size("anps:0.5m") == std::pair(2., std::string("m")));
  CHECK(size("spacing2:3ft") == std::pair(6., std::string("ft")));
  CHECK(size("anps:QL2") == size("anps:0.71m"));
  for (const char* const rule : {"", "0", "-1", "nan", "m", "2.5q", "2.5input", "QL2", "spacing2:QL2",
                                 "spacing3:1", "anps", "anps:", "anps:QL9", "anps:1 m "})
    CHECK_THROWS_AS(size(rule), Error);
}

TEST_CASE("a size has a unit or none, and a printed one reads back") {
  for (const auto& [text, bytes] : {std::pair{"0", std::uint64_t{0}},
                                    {"1500000", 1'500'000},
                                    {"512MiB", 512ull << 20},
                                    {"1GiB", 1ull << 30},
                                    {"1536MiB", 1536ull << 20}}) {
    CHECK(parse_bytes(text) == bytes);
    CHECK(print_bytes(bytes) == text);
  }
  for (const std::uint64_t bytes : {1ull, 1023ull, 1024ull, 1ull << 40, ~0ull})
    CHECK(parse_bytes(print_bytes(bytes)) == bytes);
  CHECK(parse_bytes("2 GiB") == 2ull << 30);
  CHECK(parse_bytes("3TiB") == 3ull << 40);
  CHECK(parse_bytes("7KiB") == 7 * 1024);
  CHECK(parse_bytes("2GB") == 2'000'000'000);
  for (const char* text : {"", "MiB", "-1", "1.5GiB", "1e9", "5 XiB", "5  MiB", "20000000TiB", "0x10"})
    CHECK_FALSE(parse_bytes(text));
}

}  // namespace
}  // namespace lacuna::io
