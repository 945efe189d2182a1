// SPDX-License-Identifier: Apache-2.0
#include "io/other_formats.hpp"

#include <array>

namespace lacuna::io {
namespace {

using std::string_view_literals::operator""sv;

struct OtherFormat {
  std::string_view begins;
  std::string_view name;
  std::string_view way_out;
};

constexpr std::string_view kConvert = "CloudCompare or `pdal translate` convert it to LAS or PLY";
constexpr std::string_view kUnpack = "unpack it first";

constexpr std::string_view kSaveAsUtf8 = "an editor saves it as UTF-8";

constexpr std::array kOtherFormats = {
    OtherFormat{"\x1f\x8b"sv, "a file packed by gzip", kUnpack},
    OtherFormat{"BZh"sv, "a file packed by bzip2", kUnpack},
    OtherFormat{"\xfd\x37zXZ"sv, "a file packed by xz", kUnpack},
    OtherFormat{"\x28\xb5\x2f\xfd"sv, "a file packed by zstd", kUnpack},
    OtherFormat{"PK\x03\x04"sv, "a zip archive", kUnpack},
    OtherFormat{"\x89HDF\r\n\x1a\n"sv, "HDF5", "its points must be exported to LAS, PLY or text"},
    OtherFormat{"# vtk DataFile"sv, "VTK", "ParaView exports it as PLY"},
    OtherFormat{"<VTKFile"sv, "VTK XML", "ParaView exports it as PLY"},
    OtherFormat{"CCB2"sv, "CloudCompare's BIN", "CloudCompare saves it as PLY or LAS"},
    OtherFormat{"glTF"sv, "binary glTF", "CloudCompare or Blender export it as PLY"},
    OtherFormat{"version https://git-lfs"sv, "a pointer of Git LFS",
                "`git lfs pull` fetches the file itself"},
    OtherFormat{"<?xml"sv, "XML", kConvert},
    OtherFormat{"\xff\xfe"sv, "text in UTF-16", kSaveAsUtf8},
    OtherFormat{"\xfe\xff"sv, "text in UTF-16", kSaveAsUtf8},
    OtherFormat{"<!DOCTYPE"sv, "a web page", "a download may have failed"},
    OtherFormat{"<html"sv, "a web page", "a download may have failed"},
};

}  // namespace

std::optional<std::string> describe_other_format(std::string_view first_bytes) {
  for (const OtherFormat& format : kOtherFormats) {
    if (first_bytes.starts_with(format.begins))
      return "this is " + std::string(format.name) + ", which is not read; " + std::string(format.way_out);
  }
  return std::nullopt;
}

}  // namespace lacuna::io
