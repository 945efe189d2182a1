#include "io/output_file.hpp"

#include "io/ply_writer.hpp"
#include "tests/io/io_support.hpp"

#include <catch2/catch.hpp>

namespace lacuna::test {

TEST_CASE("a file has its final name only once it is committed", "[io]") {
  const ScratchFolder folder;
  std::string expected;
  {
    OutputFile out(folder / "a.bin");
    for (int i = 0; i < 300'000; ++i) {
      const std::string word = std::to_string(i) + ' ';
      out.write(word);
      expected += word;
    }
    out.write(std::string(5u << 20, 'x'));
    expected += std::string(5u << 20, 'x');
    CHECK(folder.names() == std::vector<std::string>{"a.bin.partial"});
    out.commit();
  }
  CHECK(folder.names() == std::vector<std::string>{"a.bin"});
  CHECK(read_file(folder / "a.bin") == expected);
}

TEST_CASE("without commit nothing is left, and an older result stays", "[io]") {
  const ScratchFolder folder;
  folder.write("a.bin", "old");
  {
    OutputFile out(folder / "a.bin");
    out.write("new");
    out.close();
  }
  CHECK(folder.names() == std::vector<std::string>{"a.bin"});
  CHECK(read_file(folder / "a.bin") == "old");
}

TEST_CASE("the start of a file is overwritten, and what follows goes on behind it", "[io]") {
  const ScratchFolder folder;
  OutputFile out(folder / "a.bin");
  const std::string long_text(3u << 20, 'x');
  out.write("????" + long_text);
  out.overwrite_start("1234");
  out.write(std::as_bytes(std::span("end", 3)));
  out.overwrite_start("12");
  out.commit();
  CHECK(read_file(folder / "a.bin") == "1234" + long_text + "end");
}

TEST_CASE("a full disk is an error that names the file, and leaves nothing", "[io]") {
  const ScratchFolder folder;
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{3} << 20}) {
    std::filesystem::create_symlink("/dev/full", folder / "a.bin.partial");
    const std::string error = error_of([&] {
      OutputFile out(folder / "a.bin");
      out.write(std::string(bytes, 'x'));
      out.commit();
    });
    CHECK(error == (folder / "a.bin").string() + ": cannot be written: No space left on device");
    CHECK(folder.names().empty());
  }
}

TEST_CASE("one run at a time writes a file, and a later one takes over what a killed one has left", "[io]") {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "a.bin";
  folder.write("a.bin.partial", "left by a killed run, and longer than what follows");
  {
    OutputFile out(file);
    out.write("first");
    CHECK(error_of([&] { OutputFile other(file); }) == file.string() + ": another run is writing it");
    CHECK(folder.names() == std::vector<std::string>{"a.bin.partial"});
    out.close();  // complete, but not in place
    CHECK(error_of([&] { OutputFile other(file); }) == file.string() + ": another run is writing it");
    out.commit();
    OutputFile other(file);
    other.write("2nd");
    CHECK(read_file(file) == "first");
    other.commit();
  }
  CHECK(read_file(file) == "2nd");
  CHECK(folder.names() == std::vector<std::string>{"a.bin"});
}

TEST_CASE("a place that cannot be written is an error", "[io]") {
  const ScratchFolder folder;
  CHECK(error_of([&] { OutputFile(folder / "none" / "a.bin"); }).find("a.bin: cannot be created") !=
        std::string::npos);
  std::filesystem::create_directory(folder / "a.bin");
  CHECK(error_of([&] { OutputFile(folder / "a.bin"); }).find("is a folder") != std::string::npos);
  CHECK(folder.names() == std::vector<std::string>{"a.bin"});
}

TEST_CASE("a set of results appears together and takes the place of older ones", "[io]") {
  const ScratchFolder folder;
  folder.write("a", "old");
  folder.write("stale", "old");
  folder.write("other", "kept");
  {
    OutputSet set(folder.path());
    set.add("a").write("new a");
    set.add("b").write("new b");
    CHECK(read_file(folder / "a") == "old");
    set.commit({"stale", "not there"});
  }
  CHECK(folder.names() == std::vector<std::string>{"a", "b", "other"});
  CHECK(read_file(folder / "a") == "new a");
}

TEST_CASE("a set with one unfinished file leaves the folder as it was", "[io]") {
  const ScratchFolder folder;
  folder.write("a", "old");
  std::filesystem::create_symlink("/dev/full", folder / "b.partial");
  CHECK(error_of([&] {
          OutputSet set(folder.path());
          set.add("a").write("new a");
          set.add("b").write("new b");
          set.commit({"a"});
        }).find("No space left") != std::string::npos);
  CHECK(folder.names() == std::vector<std::string>{"a"});
  CHECK(read_file(folder / "a") == "old");
}

TEST_CASE("what the PLY writer writes, the PLY reader reads", "[io]") {
  const ScratchFolder folder;
  OutputFile out(folder / "a.ply");
  const PlyElement vertex{.name = "vertex",
                          .count = 2,
                          .properties = {{"x", Scalar::kFloat32, {}},
                                         {"y", Scalar::kFloat64, {}},
                                         {"z", Scalar::kInt16, {}},
                                         {"id", Scalar::kUint32, {}}}};
  const PlyElement edge{.name = "edge", .count = 1, .properties = {{"vertex1", Scalar::kInt32, {}}}};
  PlyWriter writer(out, {vertex, edge});
  for (const int sign : {1, -1}) {
    writer.put(0.5f * static_cast<float>(sign));
    writer.put(1e300 * sign);
    writer.put(static_cast<std::int16_t>(-7 * sign));
    writer.put_as(Scalar::kUint32, 4294967295.0);
  }
  writer.put(std::int32_t{1});
  writer.finish();
  out.commit();
  const Table table = read_table(folder / "a.ply");
  CHECK(table.names == std::vector<std::string>{"x", "y", "z", "id"});
  CHECK(table.rows ==
        std::vector<std::vector<double>>{{0.5, 1e300, -7, 4294967295.0}, {-0.5, -1e300, 7, 4294967295.0}});
}

}  // namespace lacuna::test
