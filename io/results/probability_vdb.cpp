// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "engine/store/openvdb.hpp"
#include "engine/store/vdb_transform.hpp"
#include "io/results/results.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <exception>
#include <ostream>
#include <streambuf>
#include <string>

namespace lacuna::io {
namespace {

// An OpenVDB stream begins with its magic number, three versions, whether it has offsets of its grids, and an
// identifier of 36 characters.
constexpr std::size_t kFixedBytes = 21, kIdentifierBytes = 36;

// How Lacuna's identifiers begin: its name, and the version of identifiers that are a program's own (RFC
// 9562).
constexpr std::string_view kIdentifierMark = "4c616375-6e61-8";

std::string fixed_bytes() {
  std::string bytes;
  const auto add = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  add(static_cast<openvdb::Int64>(openvdb::OPENVDB_MAGIC));
  add(static_cast<openvdb::Index32>(openvdb::OPENVDB_FILE_VERSION));
  add(static_cast<openvdb::Index32>(openvdb::OPENVDB_LIBRARY_MAJOR_VERSION));
  add(static_cast<openvdb::Index32>(openvdb::OPENVDB_LIBRARY_MINOR_VERSION));
  add('\0');
  return bytes;
}

// OpenVDB draws a random identifier. The one that replaces it depends on the content alone.
std::string identifier(std::uint64_t high, std::uint64_t low) {
  std::array<char, kIdentifierBytes + 1> text{};
  std::snprintf(text.data(), text.size(), "%s%03x-8%03x-%012llx", std::string(kIdentifierMark).c_str(),
                static_cast<unsigned>(high & 0xfff), static_cast<unsigned>(high >> 12 & 0xfff),
                static_cast<unsigned long long>(low & 0xffffffffffff));
  return text.data();
}

// Passes bytes on to a file, and hashes those behind the header.
class FileBuffer final : public std::streambuf {
 public:
  explicit FileBuffer(OutputFile& out) : out_(out) {}

  void finish() { out_.overwrite_start(fixed_bytes() + identifier(hash_ >> 40, hash_)); }

 private:
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    const auto size = static_cast<std::size_t>(count);
    out_.write(std::string_view(text, size));
    constexpr std::size_t kHeader = kFixedBytes + kIdentifierBytes;
    const std::size_t skipped = std::min(size, written_ < kHeader ? kHeader - written_ : 0);
    for (std::size_t i = skipped; i < size; ++i)  // Fowler, Noll, Vo: FNV-1a
      hash_ = (hash_ ^ static_cast<unsigned char>(text[i])) * 0x100000001b3;
    written_ += size;
    return count;
  }
  int overflow(int character) override {
    const char byte = traits_type::to_char_type(character);
    xsputn(&byte, 1);
    return character;
  }
  // The place, which is all that OpenVDB needs.
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const bool is_here = offset == 0 && from == std::ios_base::cur;
    return is_here ? pos_type(static_cast<off_type>(written_)) : pos_type(off_type(-1));
  }

  OutputFile& out_;
  std::uint64_t written_ = 0, hash_ = 0xcbf29ce484222325;
};

openvdb::FloatGrid::Ptr grid_of(const Detection& detection) {
  const ProbabilityLattice lattice = detection.probability_lattice;
  const auto grid = openvdb::FloatGrid::create(0);
  auto values = grid->getUnsafeAccessor();
  detection.for_each_probability_voxel([&](const ProbabilityVoxel& voxel) {
    values.setValue({voxel.coord[0], voxel.coord[1], voxel.coord[2]}, voxel.probability);
  });
  grid->setName("boundary_probability");
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setCreator("lacuna detect");
  grid->setTransform(vdb_transform(lattice.grid));
  grid->insertMeta(
      "value", openvdb::StringMetadata("largest boundary probability of the points in the voxel, 0 to 1"));
  grid->insertMeta(
      "unit", openvdb::StringMetadata(is_in_world_units(lattice.grid)
                                          ? "unit of the scan"
                                          : "voxel: those in units of the scan are too small or too large"));
  grid->insertMeta("voxel_edge", openvdb::DoubleMetadata(lattice.grid.edge()));
  grid->insertMeta("points_left_out",
                   openvdb::Int64Metadata(static_cast<std::int64_t>(lattice.points_left_out)));
  return grid;
}

}  // namespace

std::string_view vdb_mark() {
  static const std::string mark = fixed_bytes() + std::string(kIdentifierMark);
  return mark;
}

void write_probability_grid(const Detection& detection, OutputFile& out) {
  openvdb::initialize();
  FileBuffer buffer(out);
  std::ostream stream(&buffer);
  stream.exceptions(std::ios::badbit);  // passes errors of the file on
  try {
    openvdb::io::Stream vdb(stream);
    vdb.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK);
    vdb.write(openvdb::GridCPtrVec{grid_of(detection)});
  } catch (const openvdb::Exception& error) {
    throw Error(out.path().string() + ": cannot be written: " + error.what());
  }
  buffer.finish();
}

}  // namespace lacuna::io
