// SPDX-License-Identifier: Apache-2.0
#include "io/read/rows/scan_reader.hpp"

#include "io/read/crs/crs.hpp"

namespace lacuna::io {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

std::string known_name(std::string_view given) {
  const std::string lower = lower_case(given);
  for (const char* known : {"x", "y", "z", "nx", "ny", "nz"}) {
    if (lower == known) return lower;
  }
  return std::string(given);
}

std::string property_name(std::string_view given) {
  std::string name = known_name(given);
  for (char& c : name) {
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f) c = '_';
  }
  return name;
}

std::string bare_name(std::string_view name) {
  std::string bare = lower_case(name);
  std::erase_if(bare, [](char c) { return c == '_' || c == ' '; });
  return bare.starts_with("scalar") ? bare.substr(6) : bare;
}

bool ScanReader::is_geographic() const {
  return facts_of(crs()).is_geographic;
}

std::string ScanReader::vertical_unit() const {
  return io::vertical_unit(crs());
}

std::string ScanReader::length_unit() const {
  return io::length_unit(crs());
}

ReaderNote note_of_faces(std::uint64_t count, const char* thing) {
  return {.count = count,
          .thing = thing,
          .what =
              "; only their vertices are read; CloudCompare or MeshLab sample points on faces, which show "
              "the whole surface"};
}

std::vector<ReaderNote> notes_of(const RowFindings& findings) {
  return {
      {.count = findings.repeated_lines,
       .thing = "line",
       .what = " equal to one before the rows, such as the header of a joined file; passed over"},
      {.count = findings.other_places,
       .thing = "scan",
       .what = " whose scanner position (third line) and matrix name two places; the matrix holds, and a "
               "pose in a list of files can move the file"},
      {.count = findings.wide_angles,
       .thing = "point",
       .what = " with an azimuth or elevation beyond a full turn; angles are radians here, and these may be "
               "degrees, so that points lie at wrong places"}};
}

}  // namespace lacuna::io
