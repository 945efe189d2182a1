// SPDX-License-Identifier: Apache-2.0
// Marks of loops: their file, and how they are found again. tests/program/report_marks.py has them in the
// page.
#include "engine/run/error.hpp"
#include "io/report/match_marks.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace lacuna {
using namespace io;

namespace {

using Catch::Contains;
using nlohmann::json;

Scene::Loops loops(const std::vector<std::pair<std::uint64_t, LoopMeasures>>& drawn) {
  Scene::Loops made;
  for (const auto& [id, measures] : drawn) {
    made.ids.push_back(id);
    made.measures.push_back({measures, {}});
  }
  return made;
}

LoopMeasures hole(double x, double diameter) {
  return {.diameter = diameter, .centroid = {x, 0, 0}, .track = {}};
}

LoopMark mark(std::uint64_t id, double x, double diameter) {
  return {.id = id, .centroid = {x, 0, 0}, .diameter = diameter, .mark = "real", .note = {}};
}

using Rows = std::vector<std::optional<std::size_t>>;

Rows matched(const std::vector<LoopMark>& marks, const Scene::Loops& loops) {
  return match_marks(marks, loops).loop_of;
}

TEST_CASE("a mark finds the loop with its id, as far away as the smaller diameter and no farther") {
  const Scene::Loops one = loops({{7, hole(10, 2)}});
  CHECK(matched({mark(7, 10, 2)}, one) == Rows{0});
  CHECK(matched({mark(7, 12, 2)}, one) == Rows{0});
  CHECK(matched({mark(7, 12.01, 2)}, one) == Rows{std::nullopt});
  CHECK(matched({mark(7, 10.5, 0.6)}, one) == Rows{0});  // at one place, the size may differ
  CHECK(matched({mark(7, 10.7, 0.6)}, one) == Rows{std::nullopt});
  LoopMark outer = mark(7, 10, 2);
  outer.kind = LoopKind::kOuter;  // around a hole with an id that it had before
  CHECK(matched({outer}, one) == Rows{std::nullopt});
}

TEST_CASE("a mark with another id finds the nearest loop of its size within half of its diameter") {
  const Scene::Loops three = loops({{1, hole(0, 2)}, {2, hole(0.9, 2)}, {3, hole(9, 2)}});
  const MarkMatches matches = match_marks(std::vector{mark(40, 0.6, 2), mark(41, 8.1, 3)}, three);
  CHECK(matches.loop_of == Rows{1, 2});
  CHECK(matches.by_id == 0);
  CHECK(matches.by_place == 2);
  CHECK(matched({mark(40, 10, 2)}, three) == Rows{2});
  CHECK(matched({mark(40, 10.01, 2)}, three) == Rows{std::nullopt});
  CHECK(matched({mark(40, 9, 3.01)}, three) == Rows{std::nullopt});
  CHECK(matched({mark(40, 9, 1.33)}, three) == Rows{std::nullopt});
  CHECK(matched({mark(40, 9, 1.34)}, three) == Rows{2});
}

TEST_CASE("a loop has one mark: that with its id, then the nearest, then the first of the file") {
  const Scene::Loops two = loops({{1, hole(0, 2)}, {2, hole(5, 2)}});
  CHECK(matched({mark(9, 0, 2), mark(1, 0.5, 2)}, two) == Rows{std::nullopt, 0});
  CHECK(matched({mark(9, 5.4, 2), mark(8, 5.3, 2)}, two) == Rows{std::nullopt, 1});
  CHECK(matched({mark(9, 5.25, 2), mark(8, 4.75, 2)}, two) == Rows{1, std::nullopt});
  CHECK(matched({mark(1, 0, 2), mark(1, 0, 2)}, two) == Rows{0, std::nullopt});
}

TEST_CASE("a loop whose measures are not finite fits no mark") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(matched({mark(1, 0, 2)}, loops({{1, hole(none, 2)}})) == Rows{std::nullopt});
  CHECK(matched({mark(1, 0, 2)}, loops({{2, hole(0, none)}})) == Rows{std::nullopt});
  CHECK(matched({mark(1, 0, 2)}, {}) == Rows{std::nullopt});
  CHECK(matched({}, loops({{1, hole(0, 2)}})).empty());
}

const char* const kEntry =
    R"({"id": 3, "kind": "outer", "centroid": [1, 2.5, -3], "diameter": 4, "mark": "scan again", "note": "a <b>"})";

std::string file_of(const std::string& entries) {
  return R"({"lacuna": "0.1.0", "schema": "marks 1", "marks": [)" + entries + "]}";
}

TEST_CASE("a file of marks is read, in its order") {
  test::ScratchFolder scratch;
  const auto marks = read_marks(scratch.write("marks.json", file_of(kEntry)));
  REQUIRE(marks.size() == 1);
  CHECK(marks[0].id == 3);
  CHECK(marks[0].kind == LoopKind::kOuter);
  CHECK(marks[0].centroid == Eigen::Vector3d(1, 2.5, -3));
  CHECK(marks[0].diameter == 4);
  CHECK(marks[0].mark == "scan again");
  CHECK(marks[0].note == "a <b>");
  CHECK(read_marks(scratch.write("none.json", file_of(""))).empty());
}

TEST_CASE("a file that is no file of marks is an error of one line, with the place and what is allowed") {
  test::ScratchFolder scratch;
  const auto error = [&](const std::string& text) {
    try {
      read_marks(scratch.write("marks.json", text));
    } catch (const Error& failure) {
      CHECK(test::count_lines(failure.what()) <= 1);
      CHECK_THAT(failure.what(), Contains("marks.json: "));
      return std::string(failure.what());
    }
    return std::string("no error");
  };
  const auto changed = [&](const std::string& key, const json& value) {
    json entry = json::parse(kEntry);
    if (value.is_discarded())
      entry.erase(key);
    else
      entry[key] = value;
    return error(file_of(kEntry + std::string(",") + entry.dump()));
  };
  CHECK_THAT(
      changed("mark", "maybe"),
      Contains("marks[1].mark: \"maybe\" is not allowed; none, real, ignore, scan again and done are"));
  CHECK_THAT(changed("id", -1), Contains("marks[1].id: -1 is not allowed; a whole number from 0"));
  CHECK_THAT(changed("id", 1.5), Contains("marks[1].id: 1.5"));
  CHECK_THAT(changed("kind", "rim"), Contains("marks[1].kind: \"rim\" is not allowed; hole and outer are"));
  CHECK_THAT(changed("centroid", {1, 2}), Contains("marks[1].centroid: [1,2] is not allowed; three numbers"));
  CHECK_THAT(changed("centroid", {1, 2, nullptr}), Contains("marks[1].centroid"));
  CHECK_THAT(changed("diameter", 0), Contains("marks[1].diameter: 0 is not allowed; a number above 0"));
  CHECK_THAT(changed("note", std::string(500, 'x')), Contains("no error"));
  CHECK_THAT(changed("note", std::vector<int>(500, 1)), Contains("marks[1].note: [1,1,") && Contains("..."));
  for (const char* const key : {"id", "kind", "centroid", "diameter", "mark", "note"}) {
    CHECK_THAT(changed(key, json(json::value_t::discarded)),
               Contains("marks[1]: the key " + std::string(key) + " is missing; id, kind,"));
  }
  CHECK_THAT(error(file_of("5")), Contains("marks[0]: 5 is not allowed; an object"));
  CHECK_THAT(error("{\"schema\": \"holes 2\"}"), Contains("\"schema\": \"marks 1\" is needed"));
  CHECK_THAT(error("[]"), Contains("\"marks 1\""));
  CHECK_THAT(error("{\"schema\": \"marks 1\", \"marks\": {}}"), Contains("the key marks"));
  CHECK_THAT(error(file_of(R"({"id": 1e999})")), Contains("too large"));
  const std::string whole = file_of(kEntry);
  for (std::size_t size = 0; size < whole.size(); ++size)
    CHECK_THAT(error(whole.substr(0, size)), Contains("is not JSON; a file of marks"));
  CHECK_THROWS_WITH(read_marks(scratch.path()), Contains("is a folder; a file of marks"));
}

class Sheet {
 public:
  Sheet() {
    const Cloud cloud = plane(60).punched({20, 20}, 6).punched({42, 40}, 4).jittered(0.2, 1);
    test::detect(scratch_.write("scan.txt", cloud.text()), out());
  }
  std::string out() const { return (scratch_ / "out").string(); }
  const test::ScratchFolder& scratch() const { return scratch_; }
  // Entries for all loops, as the page saves them.
  json marks() const {
    json marks = json::array();
    const json holes = test::read_json(scratch_ / "out" / "holes.json");
    for (const json& loop : holes.at("loops")) {
      marks.push_back({{"id", loop.at("id")},
                       {"kind", loop.at("kind")},
                       {"centroid", loop.at("centroid")},
                       {"diameter", loop.at("diameter")},
                       {"mark", "real"},
                       {"note", "loop " + loop.at("id").dump() + " </script><b>"}});
    }
    return marks;
  }
  test::ProgramResult report(const json& marks) const {
    const std::string file =
        scratch_.write("marks.json", json{{"schema", "marks 1"}, {"marks", marks}}.dump());
    return test::run_program({"report", out(), "--marks", file});
  }
  json in_page() const {
    const std::string page = test::read_file(scratch_ / "out" / "report.html"), begin = "id=\"report\">";
    const std::size_t at = page.find(begin) + begin.size();
    return json::parse(page.substr(at, page.find("</script>", at) - at)).at("marks");
  }

 private:
  test::ScratchFolder scratch_;
};

TEST_CASE("lacuna report --marks puts marks into the page by id or place, and names those that fit no loop") {
  const Sheet sheet;
  json marks = sheet.marks();
  REQUIRE(marks.size() == 3);
  auto run = sheet.report(marks);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Contains("marks: 3 of 3 found their loops, 3 by id and 0 by place\n"));
  CHECK(sheet.in_page().at("id") == json{marks[0]["id"], marks[1]["id"], marks[2]["id"]});
  CHECK(sheet.in_page().at("note")[1] == marks[1]["note"]);  // no text of it ends the element

  // Ids of another run, and a hole that this one has not.
  const json old_id = marks[1]["id"];
  std::swap(marks[1]["id"], marks[2]["id"]);
  marks.push_back(marks[2]);
  marks[3]["id"] = 900;
  marks[3]["centroid"] = {-50.25, 3, 0};
  marks[3]["diameter"] = 2;
  run = sheet.report(marks);
  CHECK_THAT(run.out, Contains("marks: 3 of 4 found their loops, 1 by id and 2 by place\n"));
  CHECK_THAT(run.out, Contains("no loop fits: real, hole 900 at -50.2") && Contains("diameter 2.00"));
  const json page = sheet.in_page();
  CHECK(page.at("id")[1] == old_id);
  CHECK(page.at("note")[1] == marks[1]["note"]);
  REQUIRE(page.at("unmatched").size() == 1);
  CHECK(page.at("unmatched")[0] == marks[3]);
}

}  // namespace
}  // namespace lacuna
