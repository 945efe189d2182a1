// SPDX-License-Identifier: Apache-2.0
// lacuna report and lacuna render on the results of runs. tests/program/report_page.sh has the page in a
// browser.
#include "engine/store/temporary_folder.hpp"
#include "io/write/loops/loop_measures.hpp"
#include "io/write/report/render.hpp"
#include "io/write/report/scene.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/json.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

using nlohmann::json;

const Eigen::Vector3d kUtm(500'000, 5'400'000, 300);

class Made {
 public:
  explicit Made(const Cloud& cloud, const std::vector<std::string>& options = {}) {
    scan_ = scratch_.write("sc<an.txt", cloud.text());
    detect(options);
  }

  void detect(const std::vector<std::string>& options) { test::detect(scan_, out(), options); }
  fs::path out() const { return scratch_ / "out"; }
  std::string page() const { return read_file(out() / "report.html"); }
  const ScratchFolder& scratch() const { return scratch_; }

 private:
  ScratchFolder scratch_;
  std::string scan_;
};

Cloud sheet() {
  return plane(60).punched({20, 20}, 6).punched({42, 40}, 4).jittered(0.2, 1);
}

// RFC 4648, apart from the program's.
std::vector<std::uint8_t> decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  REQUIRE(text.size() % 4 == 0);
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < text.size(); i += 4) {
    std::uint32_t bits = 0;
    int padding = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t digit = digits.find(text[i + k]);
      padding += digit == digits.npos;
      bits = bits << 6 | static_cast<std::uint32_t>(digit == digits.npos ? 0 : digit);
    }
    for (int k = 0; k < 3 - padding; ++k) bytes.push_back(static_cast<std::uint8_t>(bits >> (16 - 8 * k)));
  }
  return bytes;
}

std::vector<Eigen::Vector3d> positions(const std::string& page, const std::string& id) {
  const json report = json_of(element(page, "report"));
  const json& origin = report.at("frame").at("origin");
  const double edge = report.at("frame").at("edge");
  const std::vector<std::uint8_t> bytes = decoded(element(page, id));
  REQUIRE(bytes.size() % 8 == 0);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t bits = 0;
    for (std::size_t k = 8; k-- > 0;) bits = bits << 8 | bytes[i + k];
    Eigen::Vector3d& point = points.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      const double unit = (static_cast<double>(bits >> (21 * axis) & 0x1fffff) + 0.5) / (1 << 21);
      point[axis] = origin[static_cast<std::size_t>(axis)].get<double>() + unit * edge;
    }
  }
  return points;
}

TEST_CASE("the data of a report are the loops and the sample, to a millionth of the scan's extent") {
  const Made made(sheet().translated(kUtm), {"--report"});
  const std::string page = made.page();
  const json report = json_of(element(page, "report"));
  const json holes = read_json(made.out() / "holes.json");
  CHECK(page.starts_with("<!doctype html>\n<!-- Lacuna report"));
  CHECK(report.at("title") == "sc<an.txt");
  CHECK(page.find("sc<an.txt") == page.npos);  // no text of the scan is taken for a tag
  CHECK(report.at("counts") == holes.at("counts"));
  CHECK(report.at("loops").at("small") == json::array({false, false, false}));

  const std::vector<Eigen::Vector3d> vertices = positions(page, "loop_vertices");
  const json& first = report.at("loops").at("first");
  REQUIRE(first.size() == holes.at("loops").size() + 1);
  REQUIRE(first.back() == vertices.size());
  std::size_t next = 0;
  for (std::size_t loop = 0; loop < holes.at("loops").size(); ++loop) {
    const json& record = holes.at("loops")[loop];
    CHECK(first[loop] == next);
    CHECK(report.at("loops").at("kind")[loop] == record.at("kind"));
    CHECK(report.at("loops").at("diameter")[loop].get<double>() ==
          Approx(record.at("diameter").get<double>()).epsilon(1e-5));
    for (const json& coordinates : record.at("coordinates")) {
      const Eigen::Vector3d& vertex = vertices.at(next++);
      for (int axis = 0; axis < 3; ++axis)
        CHECK(std::abs(vertex[axis] - coordinates[static_cast<std::size_t>(axis)].get<double>()) < 60e-6);
    }
  }
  // Numbers have the digits that a reader needs.
  for (const char* const name : {"diameter", "area", "perimeter", "confidence", "planarity"})
    for (const json& value : report.at("loops").at(name)) CHECK(value.dump().size() <= 8);
  for (const json& place : report.at("loops").at("centroid"))
    for (const json& value : place) CHECK(value.dump().size() <= 11);  // 5400000.123
  CHECK(positions(page, "positions").size() == report.at("sample").at("points"));
  CHECK(decoded(element(page, "probabilities")).size() == report.at("sample").at("points"));
  CHECK(decoded(element(page, "normals")).size() == 2 * report.at("sample").at("points").get<std::size_t>());
}

// The licence is as /usr/share/doc/libjs-three/copyright has it.
TEST_CASE("a report of finished results equals the report of the run, goes with them, and has a licence") {
  Made made(sheet(), {"--report"});
  const std::string page = made.page(), out = made.out().string();
  REQUIRE(page.find("Number.EPSILON===undefined") != page.npos);  // it contains three.js
  std::string line = page;
  std::replace(line.begin(), line.end(), '\n', ' ');
  for (const char* const part : {"three.js release 111", "Copyright (c) 2010-2019 three.js authors",
                                 "Permission is hereby granted", "\"AS IS\", WITHOUT WARRANTY"})
    CHECK_THAT(line, Contains(part));
  fs::remove(made.out() / "report.html");
  const auto run = run_program({"report", out});
  CHECK(run.exit_code == 0);
  CHECK(run.out == "written: " + (made.out() / "report.html").string() + "\n");
  CHECK((made.page() == page));
  made.detect({});
  CHECK_FALSE(fs::exists(made.out() / "report.html"));
  // A page that Lacuna did not write stays.
  std::ofstream(made.out() / "report.html") << "<!doctype html>\n<p>Mine";
  check_failure(run_program({"report", out}), 1, "--overwrite");
  CHECK(made.page() == "<!doctype html>\n<p>Mine");
  CHECK(run_program({"report", out, "--overwrite"}).exit_code == 0);
}

TEST_CASE("a run without loops or sample has a report, too") {
  for (const Cloud& cloud : {plane(3), line(50)}) {
    const Made made(cloud, {"--report", "--sample-points", "0"});
    const json report = json_of(element(made.page(), "report"));
    CHECK(report.at("loops").at("shown") <= 1);
    CHECK(run_program({"render", made.out().string(), "--out", (made.scratch() / "x.png").string()})
              .exit_code == 0);
  }
}

TEST_CASE("a scene with more than a page carries has the longest loops, and fewer points evenly") {
  const Made made(sheet());
  const Scene whole = read_scene(made.out());
  REQUIRE(whole.loops.ids.size() == 3);
  const std::size_t longest = whole.loops.first[1];  // the edge of the sheet
  for (const std::size_t positions : {800, 1600, 3000}) {
    const Scene part = read_scene(made.out(), {.positions = positions, .loops = 1});
    CHECK(part.loops.ids.size() == (longest <= positions / 4 ? 1 : 0));
    CHECK(part.loops.vertices.size() == (longest <= positions / 4 ? longest : 0));
    CHECK(part.points.positions.size() == positions - part.loops.vertices.size());
    std::array<std::size_t, 4> rows_of_quarters{};
    for (const Eigen::Vector3f& p : part.points.positions)
      ++rows_of_quarters[static_cast<std::size_t>(std::clamp(p.y() / 15, 0.0f, 3.0f))];
    for (const std::size_t rows : rows_of_quarters) CHECK(rows > part.points.positions.size() / 5);
  }
  CHECK(read_scene(made.out(), {.positions = 4000, .loops = 0}).loops.ids.empty());
}

TEST_CASE("results that are missing or not Lacuna's are an error of one line") {
  const Made made(sheet());
  const std::string out = made.out().string();
  const auto refused = [&](const std::string& part) {
    check_failure(run_program({"report", out}), 1, part);
    CHECK_FALSE(fs::exists(made.out() / "report.html"));
  };
  check_failure(run_program({"report", out + "/nowhere"}), 1, "/nowhere: not a folder");
  const std::string holes = read_file(made.out() / "holes.json");
  const auto write = [&](const std::string& text) { std::ofstream(made.out() / "holes.json") << text; };
  for (std::size_t size = 0; size < holes.size() - 2; size += 5777) {
    write(holes.substr(0, size));
    refused("holes.json");
  }
  write("{\"schema\": \"holes 9\", \"loops\": []}");
  refused("\"holes 3\" is read");
  write("[1, 2]");
  refused("holes.json");
  const std::string points = "\"points\":";
  std::string other = holes;
  other.insert(other.find(points, other.find("\"loops\": [\n")) + points.size(), 1, '1');
  write(other);
  refused("both must be of one run");
  write(holes);
  fs::resize_file(made.out() / "loops.ply", fs::file_size(made.out() / "loops.ply") - 9);
  refused("loops.ply");
  fs::remove(made.out() / "holes.json");
  refused("holes.json: is not there");
}

TEST_CASE("a report has the places to stand next, until another run has other results") {
  Made made(sheet(), {"--report"});
  const std::string out = made.out().string();
  const fs::path file = made.out() / "next_stations.geojson";
  const auto shown = [&](const char* key) { return json_of(element(made.page(), "report")).at(key); };
  const auto write = [&](const std::string& text) { std::ofstream(file) << text; };
  CHECK(shown("next_stations").is_null());
  CHECK(shown("stations").empty());

  REQUIRE(run_program({"stations", out, "--height", "20", "--range", "100"}).exit_code == 0);
  REQUIRE(run_program({"report", out}).exit_code == 0);
  const std::string text = read_file(file);
  json written = json_of(text);
  const json places = shown("next_stations");
  REQUIRE(!places.empty());
  REQUIRE(places.size() == written.at("features").size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const json& properties = written.at("features")[i].at("properties");
    CHECK(places[i].at("place") == json{properties.at("x"), properties.at("y"), properties.at("z")});
    for (const char* const key : {"rank", "area", "share"}) CHECK(places[i].at(key) == properties.at(key));
  }

  for (json& feature : written.at("features")) feature.at("geometry").at("coordinates") = {9, 48, 300};
  write(written.dump());
  REQUIRE(run_program({"report", out}).exit_code == 0);
  CHECK(shown("next_stations") == places);
  for (std::size_t size = 0; size < text.size() - 2; size += 397) {
    write(text.substr(0, size));
    check_failure(run_program({"report", out}), 1, "next_stations.geojson: ");
  }
  write(R"({"features": [{"properties": {"rank": "one"}}]})");
  check_failure(run_program({"report", out}), 1, "is not as lacuna stations writes it");
  write(text.substr(0, 200));
  CHECK(run_program({"stations", out, "--height", "20", "--range", "100"}).exit_code == 0);
  CHECK(read_file(file) == text);

  made.detect({"--report"});
  CHECK_FALSE(fs::exists(file));
}

TEST_CASE("a stray point spoils neither the report, the picture nor the printed digits, and is named") {
  const Cloud scan = sheet().translated(kUtm);
  const Cloud stray{{Eigen::Vector3d::Zero()}, {}};
  const Made clean(scan, {"--report"});
  ScratchFolder scratch;
  const std::string file = scratch.write("stray.txt", scan.joined(stray).text()),
                    out = (scratch / "out").string();
  const auto run = run_program({"detect", file, "--out", out, "--report", "--progress", "none"});
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.err, Contains("1 point lies far from all others, at 0 0 0") && Contains("--drop-origin"));
  CHECK_THAT(run.out, Contains("500020.0 5400019.7 300.0"));  // the centre of a hole
  CHECK_THAT(run_program({"info", file}).err, Contains("1 point lies far from all others, at 0 0 0"));

  const json with = json_of(element(read_file(fs::path(out) / "report.html"), "report"));
  const json without = json_of(element(clean.page(), "report"));
  for (const char* const key : {"frame", "bounds"}) CHECK(with.at(key) == without.at(key));
  CHECK(with.at("strays") == 1);
  CHECK(with.at("sample").at("points") == without.at("sample").at("points"));
  CHECK(with.at("sample").at("spacing").get<double>() ==
        Approx(without.at("sample").at("spacing").get<double>()).epsilon(0.02));
  const std::string page = read_file(fs::path(out) / "report.html");
  // The stray is a neighbour of the sheet's nearest corner: the outer curve changes there.
  for (const char* const key : {"area", "diameter", "centroid"})
    for (const std::size_t hole : {1, 2})
      CHECK(with.at("loops").at(key)[hole] == without.at("loops").at(key)[hole]);
  CHECK((element(page, "positions") == element(clean.page(), "positions")));

  const Scene scene = read_scene(out), clean_scene = read_scene(clean.out());
  CHECK(scene.points.spacing == Approx(clean_scene.points.spacing).epsilon(0.02));
  CHECK(find_view(scene, "top", 300, 200).half_height == find_view(clean_scene, "top", 300, 200).half_height);
  const auto render =
      run_program({"render", out, "--out", (scratch / "x.png").string(), "--size", "300x200"});
  CHECK_THAT(render.out, Contains("left out: 1 point far from all others"));
}

TEST_CASE("the bounds that a warning names leave strays out, and nothing else") {
  const Cloud scan = sheet().translated({-30, -30, 7});
  ScratchFolder scratch;
  const std::string file = scratch.write("scan.txt", scan.text() + "1e5 0 0\n0 0 -2e5\n");
  const std::string warning = run_program({"info", file}).err;
  CHECK_THAT(warning, Contains("2 points lie far from all others, such as at 100000 0 0"));
  const std::size_t at = warning.find("--bounds=");
  REQUIRE(at != warning.npos);
  const std::string option = warning.substr(at, warning.find(' ', at) - at);
  INFO(option);
  const auto bounded = run_program({"info", file, option, "--json"});
  CHECK(bounded.err.empty());
  CHECK(json_of(bounded.out).at("filtered_out").at("bounds") == 2);
}

// The share of a loop's pixels that are seen in a picture of it.
double share_seen(Scene scene, std::uint64_t id) {
  const View view = find_view(scene, std::to_string(id), 400, 300);
  const auto [red, green, blue] = colour_of(scene.loops.measures[*view.loop].kind);
  const Colour colour = {red, green, blue};
  const auto count = [&] {
    std::ptrdiff_t found = 0;
    render(scene, view, {400, 300}, {},
           [&](std::span<const Colour> row) { found += std::count(row.begin(), row.end(), colour); });
    return static_cast<double>(found);
  };
  const double seen = count();
  scene.points.positions.clear();
  return seen / count();
}

TEST_CASE("each hole of a room and of a hollow body is seen in its own picture") {
  ScratchFolder scratch;
  const std::string room =
      synth("scan", scratch / "room.ply", {"--stations", "1", "--points", "60000", "--seed", "2"});
  Cloud body = sphere(20000);
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 0, -1), {1, 0, 0}, {0.6, 0, 0.8}, {0, -0.8, 0.6}})
    std::erase_if(body.positions, [&](const Eigen::Vector3d& p) { return p.dot(axis) > 0.97 * p.norm(); });
  for (const std::string& scan : {room, scratch.write("body.txt", body.text())}) {
    const Scene scene = read_scene(detect(scan, scratch / (fs::path(scan).stem().string() + "_out")));
    std::size_t holes = 0;
    for (std::size_t loop = 0; loop < scene.loops.ids.size(); ++loop) {
      if (scene.loops.measures[loop].kind != LoopKind::kHole) continue;
      ++holes;
      INFO(scan << ", hole " << scene.loops.ids[loop]);
      CHECK(share_seen(scene, scene.loops.ids[loop]) > 0.5);
    }
    CHECK(holes >= 4);
  }
  // The ceiling is left out, with a word, as on the page; a height above all keeps it.
  const std::string out = (scratch / "room_out").string(), picture = (scratch / "x.png").string();
  const auto drawn = [&](const Words& more) {
    return run_program(with({"render", out, "--out", picture, "--size", "90x60"}, more)).out;
  };
  CHECK_THAT(drawn({}), Contains("left out: the ceiling above 2.") && Contains("--hide-above"));
  CHECK_THAT(drawn({"--hide-above", "9"}), !Contains("left out"));
}

}  // namespace
}  // namespace lacuna::test
