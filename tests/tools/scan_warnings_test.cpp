// SPDX-License-Identifier: Apache-2.0
#include "tools/run/scan_warnings.hpp"

#include "io/explain/stations/cause.hpp"
#include "tests/io/io_support.hpp"
#include "tests/io/results/fake_detection.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/drawn_files.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {
using namespace tools;

namespace {

using Strings = std::vector<std::string>;

std::string only(const Strings& warnings) {
  REQUIRE(warnings.size() == 1);
  return warnings[0];
}

const std::string kUtm = known_system("UTM 32N"), kFeet = known_system("Oregon", "foot\",0.3048");

std::string las(const std::string& crs) {
  return LasFile{.records = {las_record("LASF_Projection", 2112, crs)}}.bytes();
}

std::string e57(const std::string& crs) {
  const std::string root =
      crs.empty() ? "" : "<coordinateMetadata type=\"String\"><![CDATA[" + crs + "]]></coordinateMetadata>";
  return encode_e57({{.fields = e57_position({1}, {1}, {1})}}, {.root = root});
}

TEST_CASE("a file with another coordinate reference system than the first is a warning that names both") {
  const ScratchFolder folder;
  const auto a = folder.write("a.las", las(kUtm)), b = folder.write("b.las", las("EPSG:4258")),
             none = folder.write("c.xyz", "1 2 3\n");
  for (const auto& inputs : {std::vector<ScanInput>{a, b, none}, {none, a, b}}) {
    const ScanFiles scan(inputs, {});
    CHECK_THAT(only(input_warnings(scan)),
               Contains("b.las: its coordinate reference system differs from the first file: "
                        "EPSG:4258, not UTM 32N; results name none"));
    CHECK(scan.common_crs().empty());
  }
  CHECK(ScanFiles({b}, {}).common_crs() == "EPSG:4258");
  CHECK(ScanFiles({{b, parse_pose("1 2 3 0 0 0 1")}}, {}).common_crs().empty());  // not in these coordinates
}

TEST_CASE("files without a system take the system of the others, and one warning names the first of them") {
  const ScratchFolder folder;
  const auto a = folder.write("a.las", las(kFeet)), b = folder.write("b.las", LasFile().bytes()),
             c = folder.write("c.xyz", "1 2 3\n"), d = folder.write("d.las", las(kFeet));
  for (const auto& inputs : {std::vector<ScanInput>{a, b, c, d}, {b, a, c}, {b, c, d}}) {
    const ScanFiles scan(inputs, {});
    CHECK(scan.common_crs() == kFeet);
    CHECK(scan.length_unit() == "ft");
    CHECK(input_warnings(scan) ==
          Strings{b + ", and 1 more file: without a coordinate reference system; the system of the other "
                      "files holds, Oregon"});
  }
  CHECK(input_warnings(ScanFiles({b, c}, {})).empty());
  // A pose puts its points into the coordinates of the others.
  const ScanFiles posed({a, {c, parse_pose("1 2 3 0 0 0 1")}}, {});
  CHECK(posed.common_crs() == kFeet);
  CHECK(input_warnings(posed).empty());
}

TEST_CASE("a code and well-known text of one system are one system, with the unit of the code") {
  const ScratchFolder folder;
  for (const auto& [number, unit] : {std::pair(25832, "m"), {2992, "ft"}, {2263, "us-ft"}}) {
    const auto keys = las_geo_keys({{1024, 0, 1, 1}, {3072, 0, 1, static_cast<std::uint16_t>(number)}});
    const std::string name = "EPSG:" + std::to_string(number);
    const auto code =
        folder.write("code.las", LasFile{.records = {las_record("LASF_Projection", 34735, keys)}}.bytes());
    const auto text = folder.write("text.las", las(facts_of(name).known_text));
    const ScanFiles scan({code, text}, {});
    CHECK(scan.common_crs() == name);
    CHECK(scan.length_unit() == unit);
    CHECK(input_warnings(scan).empty());
  }
}

TEST_CASE("files in different units are a warning, and the scan has no unit") {
  const ScratchFolder folder;
  const auto a = folder.write("a.las", las(kFeet)), b = folder.write("b.e57", e57(""));
  const ScanFiles scan({a, b}, {});
  CHECK(scan.length_unit().empty());
  const std::vector<std::string> warnings = input_warnings(scan);
  REQUIRE(warnings.size() == 2);
  CHECK_THAT(warnings[0], Contains("b.e57: without a coordinate reference system"));
  CHECK_THAT(warnings[1], Contains("b.e57: its unit is m, not ft as in ") && Contains("--unit"));
  // Systems that differ may have other units than the one that is known.
  const auto code = folder.write("c.las", las("EPSG:25832"));
  CHECK(ScanFiles({a, code}, {}).length_unit().empty());
}

TEST_CASE("given normals that are off at one point in a hundred are a warning") {
  const auto warning = [](std::uint64_t off, NormalsUse use) {
    return normals_warning({.points = 1000, .normals_off = off}, use);
  };
  CHECK(warning(9, NormalsUse::kFitting).empty());
  CHECK_THAT(warning(23, NormalsUse::kFitting),
             StartsWith("23 normals of the scan are off by more than 45 degrees") &&
                 Contains("these are estimated from the points instead"));
  CHECK_THAT(warning(23, NormalsUse::kGiven), Contains("--normals estimated leaves them out"));
}

TEST_CASE("many loops as narrow as the gaps between points are a warning that names a --min-hole") {
  const auto of = [](std::size_t narrow, std::size_t wide) {
    std::vector<LoopMeasures> loops(narrow + wide);
    for (std::size_t i = 0; i < loops.size(); ++i) {
      loops[i].track.evidence.width = i < narrow ? 2.9 : 3;
      loops[i].track.evidence.spacing = i < narrow ? 0.03 : 7;
    }
    return small_loops_warning(loops);
  };
  CHECK(of(20, 19) ==
        "20 of 39 loops are less than 3 spacings wide, hardly more than the gaps between points; --min-hole "
        "0.3 "
        "leaves most of them out");
  CHECK(of(20, 20).empty());
  CHECK(of(19, 0).empty());
}

TEST_CASE("z in another unit is brought into the unit of x and y, but for the annotated scan") {
  const ScratchFolder folder;
  LasFile las{.records = {las_record("LASF_Projection", 2112,
                                     "COMPD_CS[\"both\"," + kUtm +
                                         ",VERT_CS[\"h\",VERT_DATUM[\"d\",2005],UNIT[\"foot\",0.3048]]]")}};
  las.points = {las_point(20, 1, 2, 1000)};
  las.scale = {1, 1, 1};
  const auto file = folder.write("a.las", las.bytes());
  const ScanFiles scan({file}, {});
  CHECK(scan.length_unit() == "m");
  CHECK(name_of_crs(scan.common_crs()) == "UTM 32N");
  PointBatch batch;
  REQUIRE(ScanPass(scan).next(batch));
  CHECK(batch.positions[0].z() == Approx(304.8));
  CHECK_THAT(input_warnings(scan).back(),
             Contains("a.las: z is in ft, and is brought into the unit of x and y"));
  InputConfig config;
  config.unit_z = LengthUnit::kM;
  const ScanFiles stated({file}, config);
  CHECK(stated.files()[0].z_factor == 1);
  CHECK(input_warnings(stated).empty());
}

TEST_CASE("a unit that contradicts the system of its file is a warning, unless the user states it") {
  const ScratchFolder folder;
  const auto scan = folder.write("a.e57", e57(kFeet));  // E57 is in metres
  CHECK_THAT(only(input_warnings(ScanFiles({scan}, {}))),
             Contains(scan + ": Oregon: ") && Contains("m holds, and --unit ft states the other"));
  InputConfig stated;
  stated.unit = LengthUnit::kM;
  CHECK(input_warnings(ScanFiles({scan}, stated)).empty());
}

TEST_CASE("a scan with neither a hole nor an outer curve is a warning that says what is likelier") {
  Detection detection;
  Summary& summary = detection.summary;
  summary.levels = {{.points = 20'000}};
  summary.mean_neighbours = 15.5;
  summary.median_distance = 0.2;
  const double area = 2.25 * std::numbers::pi * 20'000 * 0.04 / 18;
  summary.surface_area = 1.05 * area;
  CHECK_THAT(nothing_warning(detection, {}),
             Contains("neither a hole nor an outer curve among 20,000 points") && Contains("as a sphere is"));
  summary.surface_area = 0.8 * area;
  CHECK_THAT(nothing_warning(detection, {}), Contains("do not lie on one thin surface"));
  summary.mean_neighbours = 1.4;
  CHECK_THAT(nothing_warning(detection, {}),
             Contains("they have 1.4 neighbours on average") && Contains("--k"));
  summary.mean_neighbours = 15.5;
  summary.levels.push_back({.edge = 0.1, .points = 16'000});
  summary.levels.push_back({.edge = 0.4, .points = 1'500});
  CHECK_THAT(nothing_warning(detection, {}), !Contains("lie on lines"));
  summary.levels.back().points = 4'000;
  CHECK_THAT(nothing_warning(detection, {}), Contains("they lie on lines, as of a wire"));
  summary.levels.resize(1);
  summary.counts.raw_loops = 3;
  CHECK_FALSE(nothing_warning(detection, {}).empty());  // none was certain enough
  CHECK(nothing_warning(detection, {.holes_only = true}).empty());
  summary.levels = {{.points = 999}};
  CHECK(nothing_warning(detection, {}).empty());
  summary.levels = {{.points = 20'000}};
  detection.loops.emplace_back();
  CHECK(nothing_warning(detection, {}).empty());
}

TEST_CASE("stations and paths that do not count are warnings that say why and what to check") {
  StationSummary station{.name = "one", .subject = "number 6", .points = 9, .certainty = 0.5};
  const auto warning = [&] { return station_warnings({station}).at(0); };
  CHECK_THAT(warning(), Contains("station one does not count: at most 50 % of its points"));
  station.path = 7;
  CHECK_THAT(warning(), Contains("trajectory one") && Contains("and its times their clock"));
  station.certainty = 0;
  station.spread = 0.01;
  CHECK_THAT(warning(), Contains("most of its points lie within 1.1 degrees of one direction"));
  station.certainty = 0.99;
  CHECK(station_warnings({station}).empty());
  station.left_out = {1, 5008.5};
  CHECK_THAT(warning(), Contains("trajectory one: 1 row is left out, at time 5008.5: "));
  station.left_out = {};
  station.coarse_step = 0.03125;
  CHECK_THAT(warning(), Contains("trajectory one: times of points are in steps of 0.031"));
  station.coarse_step = std::numeric_limits<double>::infinity();
  station.certainty = 0;
  CHECK_THAT(only(station_warnings({station})), Contains("does not count: all of its points have one time"));
  station.coarse_step = 0;
  station.one_range = 0.9;
  station.farthest = 3;
  station.certainty = 1;
  CHECK_THAT(only(station_warnings({station})),
             Contains("many rays end 0.9 from it") &&
                 Contains("--leave-out=-0.91,-0.91,-0.91,0.91,0.91,0.91 drops"));
  station.one_range = 0;
  station.certainty = 0.46;
  station.untimed = 11;
  CHECK_THAT(warning(), Contains("55 % of the points have no time of the path"));
  station.untimed = 0;
  station.certainty = std::numeric_limits<double>::quiet_NaN();  // not known
  CHECK(station_warnings({station}).empty());
  station.path = 0;
  station.points = 100;
  station.spread = 0.02;
  CHECK(station_warnings({station}).empty());
  station.spread = 0.003;
  CHECK_THAT(warning(),
             Contains("station one, at 0 0 0, has most of its points within 0.34 degrees of one direction"));
  station.points = 0;
  CHECK(warning() == "station one does not count: the scan has no points of number 6");
  CHECK_THAT(only(station_warnings({}, {.points = 1234, .subject = "number 0 of a.ply"})),
             Contains("1,234 points have no station, such as those of number 0 of a.ply"));
}

TEST_CASE("what seems to be up, where it is not z, is a warning with the pose that turns the scan") {
  const auto warning = [](const Upward& upward) { return station_warnings({}, {}, upward).at(0); };
  CHECK_THAT(
      warning({.axis = 1, .is_known = true, .level = {1, 2345, 6}}),
      StartsWith("y seems to be up, not z, by the level surfaces (points level along x, y, z: 1, 2,345, 6)"));
  CHECK_THAT(warning({.axis = 2, .is_down = true, .is_known = true}), StartsWith("-z seems to be up, not z"));
  CHECK_THAT(warning({.axis = 0}), StartsWith("x or -x seems to be up"));
  for (const int axis : {0, 1, 2}) {
    for (const bool is_down : {false, true}) {
      if (axis == 2 && !is_down) continue;
      const std::string text = warning({.axis = axis, .is_down = is_down, .is_known = true});
      const std::size_t begin = text.find("pose=") + 5;
      const Pose pose = parse_pose(text.substr(begin, text.find('`', begin) - begin));
      CHECK((pose * (Eigen::Vector3d::Unit(axis) * (is_down ? -1 : 1))).z() == Approx(1));
    }
  }
}

// 100 x 100 points of a plane, 0.05 apart on average, whose coordinates are rounded to these steps (0: not).
FakeDetection rounded_plane(const Eigen::Vector3d& steps, const Eigen::Vector3d& slope,
                            double distance = 0.08) {
  FakeDetection found;
  const Eigen::Vector3d normal = Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
  for (std::uint64_t i = 0; i < 10'000; ++i) {
    const auto n = static_cast<double>(i);
    Eigen::Vector3d at(5 * std::fmod(n * 0.7548776662466927, 1), 5 * std::fmod(n * 0.5698402909980532, 1), 0);
    at.z() = slope.dot(at);
    for (int axis = 0; axis < 3; ++axis)
      if (steps[axis] > 0) at[axis] = steps[axis] * std::round(at[axis] / steps[axis]);
    found.sample.push_back(
        {ScanPoint::at(at, PointId{i}), 0, {float(normal.x()), float(normal.y()), float(normal.z())}});
    found.numbers.strays.rest.extend(at);
  }
  found.numbers.counts.points = found.sample.size();
  found.numbers.median_distance = distance;
  return found;
}

std::string steps_of(const FakeDetection& found, bool is_single = false) {
  const ExplainedDetection detection = found;
  return steps_warning(detection, is_single);
}

TEST_CASE("coordinates in steps wider than the spacing are a warning, whatever the axis and the format") {
  const Eigen::Vector3d slope(0.3, 0.1, 0);
  CHECK(steps_of(rounded_plane({0, 0, 0}, slope)).empty());
  CHECK(steps_of(rounded_plane({0.001, 0.001, 0.001}, slope)).empty());
  CHECK_THAT(steps_of(rounded_plane({0, 0, 0.2}, slope)),
             Contains("in steps of 0.2, and neighbours are 0.08 apart"));
  CHECK_THAT(steps_of(rounded_plane({0.25, 0, 0}, {3, 0, 0})), Contains("in steps of 0.25"));
  FakeDetection shared = rounded_plane({0.2, 0.2, 0.2}, {0, 0, 0}, 0.35);
  CHECK(steps_of(shared).empty());  // a grid in x and y
  shared.numbers.counts.duplicates = 9'300;
  CHECK_THAT(steps_of(shared),
             Contains("in steps of 0.2") && Contains("93 % of the points are at places of others"));
  FakeDetection far = rounded_plane({0, 0, 0}, slope);
  far.numbers.strays.rest.extend(Eigen::Vector3d(0, 5.4e6, 0));
  CHECK_THAT(steps_of(far, true), Contains("in steps of 0.5"));
  CHECK(steps_of(far).empty());
}

TEST_CASE("files that lie in the axes of their own scanners are a warning, and registered ones are none") {
  // A scanner in a corridor of 4 x 12, 1 from a wall, and another one at the other wall.
  const auto room = [](const Eigen::Vector3d& eye, const Eigen::Vector3d& shift, std::uint64_t first,
                       FakeDetection& found) {
    for (std::uint64_t i = 0; i < 40'000; ++i) {
      const auto n = static_cast<double>(i);
      const double turn = 2 * std::numbers::pi * std::fmod(n * 0.7548776662466927, 1);
      const double rise = 2 * std::fmod(n * 0.5698402909980532, 1) - 1;
      const Eigen::Vector3d ray(std::sqrt(1 - rise * rise) * std::cos(turn),
                                std::sqrt(1 - rise * rise) * std::sin(turn), rise);
      double range = 1e9;
      for (int axis = 0; axis < 3; ++axis) {
        const double wall = ray[axis] > 0 ? std::array{4.0, 12.0, 3.0}[static_cast<std::size_t>(axis)] : 0;
        range = std::min(range, (wall - eye[axis]) / ray[axis]);
      }
      found.sample.push_back({ScanPoint::at(eye + range * ray + shift, PointId{first + i}), 0, {0, 0, 1}});
    }
  };
  const Eigen::Vector3d a(1, 2, 1.5), b(3, 9, 1.5);
  FakeDetection own, registered;
  room(a, -a, 0, own);
  room(b, -b, 40'000, own);
  room(a, -a, 0, registered);
  room(b, -a, 40'000, registered);
  const std::vector<std::uint64_t> ends = {40'000, 80'000};
  CHECK(own_frames(ExplainedDetection(own), ends) == std::pair<std::size_t, std::size_t>(0, 1));
  CHECK_FALSE(own_frames(ExplainedDetection(registered), ends));
  CHECK_FALSE(own_frames(ExplainedDetection(own), std::vector<std::uint64_t>{80'000}));
}

// Two points, 1.7 apart.
std::string pcd(double corner, const std::string& viewpoint) {
  const std::string low = std::to_string(corner), high = std::to_string(corner + 1);
  return ascii_pcd(low + " " + low + " 0\n" + high + " " + high + " 1\n", viewpoint);
}

Strings warnings_of_filters(const std::string& file, const InputConfig& config) {
  const ScanFiles scan({file}, config);
  Eigen::AlignedBox3d bounds;
  ScanPass pass(scan);
  for (const Eigen::Vector3d& position : read_points(pass).positions)
    if (position.allFinite()) bounds.extend(position);
  return filter_warnings(scan, pass.counts(), bounds);
}

TEST_CASE("files around 0 0 0 whose viewpoints are elsewhere are a warning") {
  const ScratchFolder folder;
  // Points on a circle around a place.
  const auto file = [&](const std::string& name, double x, const std::string& viewpoint) {
    std::string rows;
    for (int i = 0; i < 100; ++i)
      rows += std::to_string(x + 2 * std::cos(0.0628 * i)) + " " + std::to_string(2 * std::sin(0.0628 * i)) +
              " -1\n";
    return folder.write(name, ascii_pcd(rows, viewpoint));
  };
  const auto warnings = [](const std::vector<ScanInput>& files) {
    const ScanFiles scan(files, {});
    ScanPass pass(scan), kept(scan);
    read_points(pass);
    kept.set_pass_counts(pass.pass_counts());  // as of a run that goes on
    CHECK(filter_warnings(scan, kept.counts(), {}) == filter_warnings(scan, pass.counts(), {}));
    return filter_warnings(scan, pass.counts(), {});
  };
  const auto first = file("first.pcd", 0, "0 0 0"), own = file("own.pcd", 0, "3 0 1.5"),
             other = file("other.pcd", 0, "0 -9 0"), world = file("world.pcd", 3, "3 0 1.5"),
             text = folder.write("a.xyz", "1 2 3\n");
  CHECK_THAT(
      only(warnings({own, other})),
      Contains("own.pcd, and 1 more file: points lie around 0 0 0, and not around the viewpoint 3 0 1.5; ") &&
          Contains("`FILE pose=viewpoint`"));
  CHECK(warnings({first, own}).size() == 1);
  for (const auto& files : {std::vector<ScanInput>{own},
                            {own, text},
                            {first, world},
                            {own, world},
                            {own, own},
                            {{own, parse_pose("3 0 1.5 0 0 0 1")}, {other, parse_pose("0 -9 0 0 0 0 1")}}})
    CHECK(warnings(files).empty());
}

TEST_CASE("records of a LAS file that name two systems are a warning with both, unless the user states one") {
  const ScratchFolder folder;
  LasFile file{.records = {las_record("LASF_Projection", 34735, las_geo_keys({{3072, 0, 1, 25832}})),
                           las_record("LASF_Projection", 2112, known_system("UTM 33N", "metre\",1", 25833))}};
  for (const int format : {0, 6}) {
    file.format = format;
    file.minor = format < 6 ? 2 : 4;
    file.points = {las_point(format < 6 ? 20 : 30, 1, 2, 3)};
    for (const auto& [bits, holds] : {std::pair(0, "EPSG:25832"), std::pair(16, "UTM 33N")}) {
      std::string bytes = file.bytes();
      put(bytes, 6, static_cast<std::uint16_t>(bits));
      const auto las = folder.write("a.las", bytes);
      CHECK_THAT(
          only(input_warnings(ScanFiles({las}, {}))),
          Contains("EPSG:25832") && Contains("UTM 33N") && Contains(std::string("; ") + holds + " holds"));
    }
  }
}

TEST_CASE("faces of a mesh are a warning with their number, in every format that has them") {
  const ScratchFolder folder;
  const std::string places = "0 0 0\n1 0 0\n0 1 0\n", list = "\nproperty list uchar int vertex_indices\n";
  const auto ply = [&](const std::string& element, const std::string& rows) {
    return ply_header(vertices(3) + "element " + element + list) + places + rows;
  };
  const auto warnings = [&](const std::vector<ScanInput>& files) {
    return input_warnings(ScanFiles(files, {}));
  };
  std::vector<ScanInput> files;
  for (const auto& [name, content, faces] :
       {std::tuple{"a.ply", ply("face 2", "3 0 1 2\n3 2 1 0\n"), "2 faces"},
        {"b.ply", ply("tristrips 1", "3 0 1 2\n"), "1 triangle strip"},
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "1 face"}}) {
    files.emplace_back(folder.write(name, content));
    CHECK_THAT(only(warnings({files.back()})),
               Contains(std::string(name) + ": " + faces + "; only their vertices are read"));
  }
  const auto points = folder.write("c.ply", ply("face 0", ""));
  CHECK(warnings({points}).empty());
  CHECK_THAT(only(warnings({points, {files[0].name, parse_pose("1 2 3 0 0 0 1")}, files[2]})),
             Contains("a.ply, and 1 more file: 3 faces; only their vertices are read"));
}

TEST_CASE("points of LAS that are left out as noise are a warning where they are many") {
  const ScratchFolder folder;
  std::vector<int> classes(97, 2);
  classes.insert(classes.end(), {7, 18, 7});
  const auto few = folder.write("few.las", las_of_classes(classes));
  CHECK(warnings_of_filters(few, {}).empty());
  classes.push_back(7);
  const auto many = folder.write("many.las", las_of_classes(classes));
  CHECK_THAT(only(warnings_of_filters(many, {})),
             Contains("4 points, 4 %, are left out as noise, of the classes 7 and 18"));
  CHECK(warnings_of_filters(many, {.keep_noise = true}).empty());
}

TEST_CASE(
    "the option --drop-origin that drops nothing is a warning where the scanner is said to be at 0 0 0, far "
    "away") {
  const ScratchFolder folder;
  const auto warnings = [&](double corner, const std::string& viewpoint, bool drops) {
    return warnings_of_filters(folder.write("a.pcd", pcd(corner, viewpoint)), {.drop_origin = drops});
  };
  CHECK(warnings(100, "0 0 0", true).size() == 1);
  CHECK(warnings(100, "0 0 0", false).empty());
  CHECK(warnings(100, "99 99 2", true).empty());
  CHECK(warnings(-0.5, "0 0 0", true).empty());
  const auto ply = [&](const std::string& camera, const std::string& rows) {
    const std::string header = ply_header(kCamera + vertices(2, kWideXyz));
    return warnings_of_filters(folder.write("a.ply", header + camera + "\n" + rows), {.drop_origin = true});
  };
  CHECK_THAT(only(ply("0 0 0", "1000 2000 3\n1010 2010 3\n")),
             Contains("a.ply: the place of the scanner is 0 0 0, far from the points"));
  CHECK(ply("1005 2005 4", "1000 2000 3\n1010 2010 3\n").empty());
  CHECK(ply("0 0 0", "10 -10 3\n-10 10 3\n").empty());
  CHECK(ply("0 0 0", "1000 2000 3\n0 0 0\n").empty());  // it drops a point
}

}  // namespace
}  // namespace lacuna::test
