// SPDX-License-Identifier: Apache-2.0
#include "bench/scan_files.hpp"

#include "engine/run/error.hpp"
#include "io/files/little_endian.hpp"
#include "io/laz/laz_encoder.hpp"
#include "tests/support/e57_encoder.hpp"
#include "tests/support/laz_data.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <liblzf/lzf.h>

namespace lacuna {
using namespace io;

namespace {

using Eigen::Vector3d;

constexpr std::array<std::size_t, 9> kLasBytes = {20, 28, 26, 34, 0, 0, 30, 36, 38};  // of a point, by format

// Values that a scanner may measure besides the position.
std::uint16_t intensity(std::size_t i) {
  return static_cast<std::uint16_t>(20'000 + 10'000 * std::sin(static_cast<double>(i) * 1e-3) +
                                    i * 7919 % 512);
}
std::uint16_t colour(std::size_t i, std::size_t channel) {
  return static_cast<std::uint16_t>(intensity(i + 1000 * channel) & 0xff00);
}

void write_file(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw Error(file.string() + ": cannot be written");
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_digits(std::string& text, double value, char behind) {
  std::array<char, 32> digits;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, 4);
  text.append(digits.data(), end.ptr);
  text += behind;
}

// ---- PLY, text, PTX, OBJ, STL, PCD

template <class Coordinate>
std::string binary_rows(const PointBatch& sample) {
  std::string rows;
  for (const Vector3d& p : sample.positions) {
    for (const double c : p) append(rows, static_cast<Coordinate>(c));
  }
  return rows;
}

std::string text_rows(const PointBatch& sample, std::string_view before, std::string_view behind) {
  std::string rows;
  for (const Vector3d& p : sample.positions) {
    rows += before;
    for (const double c : p) append_digits(rows, c, ' ');
    rows.pop_back();
    rows += behind;
  }
  return rows;
}

std::string ply_header(const PointBatch& sample, const std::string& format, const std::string& type) {
  std::string header =
      "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(sample.size()) + "\n";
  for (const char* axis : {"x", "y", "z"}) header += "property " + type + " " + axis + "\n";
  return header + "end_header\n";
}

void write_ply(const PointBatch& sample, const std::filesystem::path& file) {
  write_file(file, ply_header(sample, "binary_little_endian", "float") + binary_rows<float>(sample));
}

void write_ply_double(const PointBatch& sample, const std::filesystem::path& file) {
  write_file(file, ply_header(sample, "binary_little_endian", "double") + binary_rows<double>(sample));
}

void write_ply_ascii(const PointBatch& sample, const std::filesystem::path& file) {
  write_file(file, ply_header(sample, "ascii", "float") + text_rows(sample, "", "\n"));
}

void write_xyz(const PointBatch& sample, const std::filesystem::path& file) {
  write_file(file, text_rows(sample, "", "\n"));
}

void write_ptx(const PointBatch& sample, const std::filesystem::path& file) {
  write_file(file, std::to_string(sample.size()) +
                       "\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n" +
                       text_rows(sample, "", " 0.5\n"));
}

void write_obj(const PointBatch& sample, const std::filesystem::path& file) {
  write_file(file, text_rows(sample, "v ", "\n"));
}

// Each point has a triangle with the next two points; the reader takes each corner once a triangle.
void write_stl(const PointBatch& sample, const std::filesystem::path& file) {
  const std::size_t triangles = sample.size() / 3;
  std::string bytes(80, ' ');
  append(bytes, static_cast<std::uint32_t>(triangles));
  for (std::size_t i = 0; i < triangles; ++i) {
    bytes.append(12, '\0');  // normal
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (const double c : sample.positions[3 * i + corner]) append(bytes, static_cast<float>(c));
    }
    bytes.append(2, '\0');
  }
  write_file(file, bytes);
}

std::string pcd_header(const PointBatch& sample, const std::string& data) {
  const std::string points = std::to_string(sample.size());
  return "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + points +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
}

void write_pcd(const PointBatch& sample, const std::filesystem::path& file) {
  write_file(file, pcd_header(sample, "binary") + binary_rows<float>(sample));
}

void write_pcd_compressed(const PointBatch& sample, const std::filesystem::path& file) {
  std::string columns;
  for (const Eigen::Index axis : {0, 1, 2}) {
    for (const Vector3d& p : sample.positions) append(columns, static_cast<float>(p[axis]));
  }
  std::string packed(columns.size() + columns.size() / 16 + 64, '\0');
  const unsigned bytes = lzf_compress(columns.data(), static_cast<unsigned>(columns.size()), packed.data(),
                                      static_cast<unsigned>(packed.size()));
  std::string sizes;
  append(sizes, static_cast<std::uint32_t>(bytes));
  append(sizes, static_cast<std::uint32_t>(columns.size()));
  write_file(file, pcd_header(sample, "binary_compressed") + sizes + packed.substr(0, bytes));
}

// ---- E57

void write_e57(const PointBatch& sample, const std::filesystem::path& file) {
  test::E57TestScan scan{.packets = 1 + 3 * sizeof(float) * sample.size() / 30'000};
  for (const Eigen::Index axis : {0, 1, 2}) {
    std::vector<float> values;
    for (const Vector3d& p : sample.positions) values.push_back(static_cast<float>(p[axis]));
    scan.fields.push_back(test::e57_floats(std::string("cartesian") + "XYZ"[axis], values));
  }
  write_file(file, test::encode_e57({scan}));
}

// ---- LAS and LAZ

// Steps are a fiftieth of the typical distance between points, as 1 mm is of 5 cm.
double las_scale(const PointBatch& sample) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : sample.positions) box.extend(p);
  return box.sizes().maxCoeff() / std::sqrt(static_cast<double>(sample.size())) / 50;
}

std::vector<std::byte> las_records(const PointBatch& sample, std::size_t format, double scale) {
  const std::size_t bytes = kLasBytes.at(format);
  std::vector<std::byte> records(sample.size() * bytes);
  for (std::size_t i = 0; i < sample.size(); ++i) {
    std::byte* const at = &records[i * bytes];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double c = sample.positions[i][static_cast<Eigen::Index>(axis)];
      store(at + 4 * axis, static_cast<std::int32_t>(std::lround(c / scale)));
    }
    store(at + 12, intensity(i));
    const bool is_new = format >= 6;
    store(at + 14, static_cast<std::uint8_t>(is_new ? 0x11 : 0x09));  // return 1 of 1
    store(at + (is_new ? 16 : 15), std::uint8_t{2});
    store(at + (is_new ? 20 : 18), std::uint16_t{1});
    store(at + (is_new ? 22 : 20), 3e5 + static_cast<double>(i) * 2e-6);
    for (std::size_t channel = 0; channel < 3; ++channel)
      store(at + (is_new ? 30 : 28) + 2 * channel, colour(i, channel));
  }
  return records;
}

void write_las(const PointBatch& sample, const std::filesystem::path& file, std::size_t format,
               bool is_compressed) {
  const int minor = format >= 6 ? 4 : 2;
  const double scale = las_scale(sample);
  const std::vector<std::byte> records = las_records(sample, format, scale);
  const auto layout = test::laz_layout(static_cast<int>(format), 0, 50'000, format >= 6 ? 3 : 2);
  test::LazBytes laszip;
  if (is_compressed) laszip = laz::layout_record(layout);

  std::vector<std::byte> head(minor == 4 ? 375 : 227);
  const auto header_bytes = static_cast<std::uint16_t>(head.size());
  if (is_compressed) {
    head.resize(head.size() + 54);
    std::memcpy(&head[header_bytes + 2], "laszip encoded", 14);
    store(&head[header_bytes + 18], std::uint16_t{22204});
    store(&head[header_bytes + 20], static_cast<std::uint16_t>(laszip.size()));
    head.insert(head.end(), laszip.begin(), laszip.end());
  }
  std::memcpy(head.data(), "LASF", 4);
  store(&head[24], std::uint8_t{1});
  store(&head[25], static_cast<std::uint8_t>(minor));
  store(&head[94], header_bytes);
  store(&head[96], static_cast<std::uint32_t>(head.size()));
  store(&head[100], static_cast<std::uint32_t>(is_compressed));
  store(&head[104], static_cast<std::uint8_t>(format | (is_compressed ? 0x80 : 0)));
  store(&head[105], static_cast<std::uint16_t>(kLasBytes.at(format)));
  if (minor == 4) store(&head[247], std::uint64_t{sample.size()});
  if (minor == 2) store(&head[107], static_cast<std::uint32_t>(sample.size()));
  for (const std::size_t axis : {0, 1, 2}) store(&head[131 + 8 * axis], scale);

  test::LazBytes points = records;
  if (is_compressed) {
    std::vector<std::uint64_t> chunks(sample.size() / 50'000, 50'000);
    if (sample.size() % 50'000 != 0) chunks.push_back(sample.size() % 50'000);
    points = test::laz_point_data(layout, records, chunks, head.size());
  }
  head.insert(head.end(), points.begin(), points.end());
  write_file(file, {reinterpret_cast<const char*>(head.data()), head.size()});
}

template <std::size_t kFormat, bool kIsCompressed>
void write_las(const PointBatch& sample, const std::filesystem::path& file) {
  write_las(sample, file, kFormat, kIsCompressed);
}

constexpr std::array kFormats = {
    SampleFormat{"PLY, binary, float", "ply", write_ply},
    SampleFormat{"PLY, binary, double", "ply", write_ply_double},
    SampleFormat{"PCD, binary", "pcd", write_pcd},
    SampleFormat{"PCD, compressed", "pcd", write_pcd_compressed},
    SampleFormat{"E57, float", "e57", write_e57},
    SampleFormat{"STL, binary", "stl", write_stl},
    SampleFormat{"LAS 1.2, format 3", "las", write_las<3, false>},
    SampleFormat{"LAS 1.4, format 7", "las", write_las<7, false>},
    SampleFormat{"LAZ 1.2, format 3", "laz", write_las<3, true>},
    SampleFormat{"LAZ 1.4, format 6", "laz", write_las<6, true>},
    SampleFormat{"LAZ 1.4, format 7", "laz", write_las<7, true>},
    SampleFormat{"PLY, ascii", "ply", write_ply_ascii},
    SampleFormat{"text", "xyz", write_xyz},
    SampleFormat{"PTX", "ptx", write_ptx},
    SampleFormat{"OBJ", "obj", write_obj},
};

}  // namespace

std::span<const SampleFormat> sample_formats() {
  return kFormats;
}

}  // namespace lacuna
