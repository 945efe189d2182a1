// SPDX-License-Identifier: Apache-2.0
#include "io/read/formats.hpp"

#include "io/read/e57/e57.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/rows/readers.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace lacuna::io {
namespace {

struct FormatLine {
  Format format;
  const char* name;
  bool (*recognises)(const FileStart& start);
  std::unique_ptr<ScanReader> (*open)(const std::filesystem::path& file, const ReadOptions& options);
};

// Tried in this order: those with a name of their own at the beginning come first.
constexpr std::array kFormats = {
    FormatLine{Format::kPly, "PLY", looks_like_ply, open_ply},
    FormatLine{Format::kLas, "LAS", looks_like_las, open_las},
    FormatLine{Format::kPcd, "PCD", looks_like_pcd, open_pcd},
    FormatLine{Format::kE57, "E57", looks_like_e57, open_e57},
    FormatLine{Format::kObj, "OBJ", looks_like_obj, open_obj},
    FormatLine{Format::kPtx, "PTX", looks_like_ptx, open_ptx},
    FormatLine{Format::kText, "text (xyz, csv, pts)", looks_like_text, open_text},
};

using std::string_view_literals::operator""sv;

struct OtherFormat {
  std::string_view begins;
  std::string_view name;
  std::string_view way_out;
};

constexpr std::string_view kZip = "PK\x03\x04"sv;

constexpr std::string_view kMeshLab = "MeshLab saves it as PLY";
constexpr std::string_view kExportPoints = "its points must be exported to LAS, PLY or text";
constexpr std::string_view kGridToText = "`gdal_translate -of XYZ IN OUT.xyz` makes points of its cells";
constexpr std::string_view kUnpack = "unpack it first";
constexpr std::string_view kTakesArrays =
    "lacuna.find_holes of Python takes arrays, and numpy.savetxt writes text";
constexpr std::string_view kSaveAsUtf8 = "an editor saves it as UTF-8";

constexpr std::array kOtherFormats = {
    OtherFormat{"\x1f\x8b"sv, "a file packed by gzip", kUnpack},
    OtherFormat{"BZh"sv, "a file packed by bzip2", kUnpack},
    OtherFormat{"\xfd\x37zXZ"sv, "a file packed by xz", kUnpack},
    OtherFormat{"\x28\xb5\x2f\xfd"sv, "a file packed by zstd", kUnpack},
    OtherFormat{kZip, "a zip archive", kUnpack},
    OtherFormat{"DRACO"sv, "Draco", "`draco_decoder -i IN -o OUT.ply` converts it"},
    OtherFormat{"AutoCAD Binary DXF"sv, "DXF", kExportPoints},
    OtherFormat{"AC10"sv, "DWG", kExportPoints},
    OtherFormat{"DSAA"sv, "a grid of Surfer", kGridToText},
    OtherFormat{"DSBB"sv, "a grid of Surfer", kGridToText},
    OtherFormat{"\x89HDF\r\n\x1a\n"sv, "HDF5", kExportPoints},
    OtherFormat{"# vtk DataFile"sv, "VTK", "ParaView exports it as PLY"},
    OtherFormat{"<VTKFile"sv, "VTK XML", "ParaView exports it as PLY"},
    OtherFormat{"CCB2"sv, "CloudCompare's BIN", "CloudCompare saves it as PLY or LAS"},
    OtherFormat{"PAR1"sv, "Parquet", kExportPoints},
    OtherFormat{"\x93NUMPY"sv, "an array of NumPy", kTakesArrays},
    OtherFormat{"glTF"sv, "binary glTF", "CloudCompare or Blender export it as PLY"},
    OtherFormat{"version https://git-lfs"sv, "a pointer of Git LFS",
                "`git lfs pull` fetches the file itself"},
    OtherFormat{"<?xml"sv, "XML", kExportPoints},
    OtherFormat{"\xff\xfe"sv, "text in UTF-16", kSaveAsUtf8},
    OtherFormat{"\xfe\xff"sv, "text in UTF-16", kSaveAsUtf8},
    OtherFormat{"<!DOCTYPE"sv, "a web page", "a download may have failed"},
    OtherFormat{"<html"sv, "a web page", "a download may have failed"},
};

// Formats without first bytes of their own are known by their names.
struct NamedFormat {
  std::string_view ending;
  std::string_view begins;  // may be empty
  std::string_view name;
  std::string_view way_out;
};

constexpr std::string_view kFromReCap = "Autodesk ReCap exports it as E57",
                           kFromMaker = "the scanner's program exports it as E57";

constexpr std::array kNamedFormats = {
    NamedFormat{".rcp", "", "a project of Autodesk ReCap", kFromReCap},
    NamedFormat{".rcs", "", "a scan of Autodesk ReCap", kFromReCap},
    NamedFormat{".fls", "", "a scan of FARO", kFromMaker},
    NamedFormat{".rxp", "", "a scan of RIEGL", kFromMaker},
    NamedFormat{".rdbx", "", "a scan of RIEGL", kFromMaker},
    NamedFormat{".zfs", "", "a scan of Zoller + Froehlich", kFromMaker},
    NamedFormat{".npz", kZip, "an archive of NumPy", kTakesArrays},
    NamedFormat{".slpk", kZip, "a scene layer package", "ArcGIS Pro exports its points as LAS"},
};

std::string describe(std::string_view name, std::string_view way_out) {
  return "this is " + std::string(name) + ", which is not read; " + std::string(way_out);
}

// The first two words of text, in lower case.
std::array<std::string, 2> first_words(std::string_view text) {
  std::array<std::string, 2> words;
  std::size_t at = 0;
  for (std::string& word : words) {
    at = std::min(text.find_first_not_of(kBlanks, at), text.size());
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    word = lower_case(text.substr(at, end - at));
    at = end;
  }
  return words;
}

// Names a format that is not read, and a way out.
std::optional<std::string> describe_other_format(const std::filesystem::path& file,
                                                 std::string_view first_bytes) {
  const std::string ending = lower_case(file.extension().string());
  for (const NamedFormat& format : kNamedFormats) {
    if (ending == format.ending && first_bytes.starts_with(format.begins))
      return describe(format.name, format.way_out);
  }
  const auto [first, second] = first_words(first_bytes);
  if (first.ends_with("off") && first.size() <= 5) return describe("OFF", kMeshLab);  // and NOFF, STOFF
  if (first == "ncols" || first == "nrows") return describe("a grid of Esri (ASC)", kGridToText);
  if ((first == "0" && second == "section") ||
      (first == "999" && first_bytes.find("\nSECTION") != first_bytes.npos))
    return describe("DXF", kExportPoints);
  if (first == "solid" && lower_case(first_bytes).find("facet normal") != first_bytes.npos)
    return describe("STL", kMeshLab);
  if (first.starts_with('{'))
    return describe("JSON",
                    "of points of GeoJSON, `ogr2ogr -f CSV OUT.csv IN -lco GEOMETRY=AS_XYZ` makes text");
  for (const OtherFormat& format : kOtherFormats) {
    if (first_bytes.starts_with(format.begins)) return describe(format.name, format.way_out);
  }
  return std::nullopt;
}

constexpr std::size_t kFirstBytes = 4096;

FileStart file_start(InputFile& in) {
  const std::uint64_t size = in.remaining();
  return {.first_bytes = in.peek(kFirstBytes), .size = size};
}

std::optional<Format> find_format(const FileStart& start) {
  const auto line = std::ranges::find_if(kFormats, [&](const auto& f) { return f.recognises(start); });
  return line == kFormats.end() ? std::nullopt : std::optional(line->format);
}

std::string format_names() {
  std::string names;
  for (const FormatLine& line : kFormats) names += (names.empty() ? "" : ", ") + std::string(line.name);
  return names;
}

}  // namespace

std::optional<Format> find_format(const std::filesystem::path& file) {
  InputFile in(file, kFirstBytes);
  const FileStart start = file_start(in);
  if (start.first_bytes.empty() || describe_other_format(file, start.first_bytes)) return std::nullopt;
  return find_format(start);
}

Format format_of(const std::filesystem::path& file) {
  InputFile in(file, kFirstBytes);
  const FileStart start = file_start(in);
  if (start.first_bytes.empty()) in.fail_at_byte(0, "the file is empty; a scan file is needed");
  if (const auto other = describe_other_format(file, start.first_bytes)) in.fail_at_byte(0, *other);
  if (const std::optional<Format> format = find_format(start)) return *format;
  in.fail_at_byte(
      0, "unknown format; " + format_names() + " are read. CloudCompare or `pdal translate` may convert it");
}

std::unique_ptr<ScanReader> open_scan(Format format, const std::filesystem::path& file,
                                      const ReadOptions& options) {
  return std::ranges::find(kFormats, format, &FormatLine::format)->open(file, options);
}

std::unique_ptr<ScanReader> open_scan(const std::filesystem::path& file, const ReadOptions& options) {
  return open_scan(format_of(file), file, options);
}

}  // namespace lacuna::io
