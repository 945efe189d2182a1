// SPDX-License-Identifier: Apache-2.0
#include "tests/support/las_file.hpp"

#include "io/read/files/number.hpp"
#include "io/read/laz/laz.hpp"

namespace lacuna::test {

std::string las_record(const std::string& user, std::uint16_t number, const std::string& data) {
  std::string bytes(54, '\0');
  std::memcpy(&bytes[2], user.data(), user.size());
  put<std::uint16_t>(bytes, 18, number);
  put<std::uint16_t>(bytes, 20, static_cast<std::uint16_t>(data.size()));
  return bytes + data;
}

std::string las_extended_record(const std::string& user, std::uint16_t number, const std::string& data) {
  std::string bytes(60, '\0');
  std::memcpy(&bytes[2], user.data(), user.size());
  put<std::uint16_t>(bytes, 18, number);
  put<std::uint64_t>(bytes, 20, data.size());
  std::memcpy(&bytes[28], "what it is", 10);
  return bytes + data;
}

std::string with_extended(std::string bytes, const std::vector<std::string>& records) {
  put<std::uint64_t>(bytes, 235, bytes.size());
  put(bytes, 243, static_cast<std::uint32_t>(records.size()));
  for (const std::string& record : records) bytes += record;
  return bytes;
}

std::string known_system(const std::string& name, const std::string& unit, int code) {
  const std::string degrees =
      "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
      "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]";
  if (name == "GEOGCS") return degrees;
  return "PROJCS[\"" + name + "\"," + degrees +
         ",PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],"
         "PARAMETER[\"central_meridian\",9],PARAMETER[\"scale_factor\",0.9996],"
         "PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0],UNIT[\"" +
         unit + "]" + (code == 0 ? "" : ",AUTHORITY[\"EPSG\",\"" + std::to_string(code) + "\"]") + "]";
}

std::string las_geo_keys(const std::vector<std::array<std::uint16_t, 4>>& keys) {
  std::string data;
  const auto add = [&](std::size_t number) { put(data, data.size(), static_cast<std::uint16_t>(number)); };
  for (const std::size_t head : {std::size_t{1}, std::size_t{1}, std::size_t{0}, keys.size()}) add(head);
  for (const auto& key : keys)
    for (const std::uint16_t number : key) add(number);
  return data;
}

std::string las_extra_descriptor(const std::string& name, std::uint8_t type, std::uint8_t options,
                                 double scale, double offset) {
  std::string bytes(192, '\0');
  put(bytes, 2, type);
  put(bytes, 3, options);
  std::memcpy(&bytes[4], name.data(), name.size());
  put(bytes, 112, scale);
  put(bytes, 136, offset);
  return bytes;
}

std::string las_point(std::size_t bytes, std::int32_t x, std::int32_t y, std::int32_t z) {
  std::string point(bytes, '\0');
  put(point, 0, x);
  put(point, 4, y);
  put(point, 8, z);
  return point;
}

std::vector<std::string> las_points_alike(std::size_t bytes, std::size_t count) {
  std::mt19937 random(static_cast<std::mt19937::result_type>(bytes));
  std::vector<std::string> points;
  while (points.size() < count) {
    points.push_back(points.empty() ? las_point(bytes, 1000, -2000, 300) : points.back());
    for (int change = 0; change < 5 && points.size() > 1; ++change)
      points.back()[random() % bytes] = static_cast<char>(random());
  }
  return points;
}

std::string las_of_classes(const std::vector<int>& classes) {
  LasFile las;
  for (const int number : classes) {
    las.points.push_back(las_point(20, static_cast<std::int32_t>(las.points.size()), 2, 3));
    put(las.points.back(), 15, static_cast<std::uint8_t>(number));
  }
  return las.bytes();
}

std::string LasFile::bytes() const {
  constexpr std::array<std::uint16_t, 5> kHeader = {227, 227, 227, 235, 375};
  std::string file(kHeader.at(static_cast<std::size_t>(minor)), '\0');
  const auto header_bytes = static_cast<std::uint16_t>(file.size());
  std::memcpy(file.data(), "LASF", 4);
  put<std::uint8_t>(file, 24, 1);
  put(file, 25, static_cast<std::uint8_t>(minor));
  put(file, 94, header_bytes);
  put(file, 100, static_cast<std::uint32_t>(records.size()));
  put(file, 104, static_cast<std::uint8_t>(format));
  put(file, 105, static_cast<std::uint16_t>(points.empty() ? 20 : points[0].size()));
  const bool is_long = minor == 4;
  put(file, 107, static_cast<std::uint32_t>(is_long ? 0 : points.size()));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(file, 131 + 8 * axis, scale[axis]);
    put(file, 155 + 8 * axis, offset[axis]);
  }
  if (is_long) put(file, 247, static_cast<std::uint64_t>(points.size()));
  for (const std::string& r : records) file += r;
  put(file, 96, static_cast<std::uint32_t>(file.size()));
  for (const std::string& p : points) file += p;
  return file;
}

// ---- Compressed points

laz::Layout laz_layout(int point_format, std::uint16_t extra_bytes, std::uint32_t chunk_points,
                       std::uint16_t version) {
  laz::Layout layout = laz::layout_of(point_format, extra_bytes);
  layout.chunk_points = chunk_points;
  for (laz::Item& item : layout.items)
    if (item.type != laz::item_type::kWavepacket13) item.version = version;
  return layout;
}

LazBytes laz_point_data(const laz::Layout& layout, std::span<const std::byte> records,
                        std::span<const std::uint64_t> chunk_points, std::uint64_t offset) {
  LazBytes data(8);
  std::vector<laz::Chunk> chunks;
  for (const std::uint64_t points : chunk_points) {
    const LazBytes chunk = laz::encode_chunk(layout, records.first(points * layout.record_bytes()));
    records = records.subspan(points * layout.record_bytes());
    chunks.push_back({offset + data.size(), chunk.size(), points});
    data.insert(data.end(), chunk.begin(), chunk.end());
  }
  store(data.data(), offset + data.size());
  const LazBytes table = laz::encode_chunk_table(layout, chunks);
  data.insert(data.end(), table.begin(), table.end());
  return data;
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string laz_head(LasFile las, const laz::Layout& layout) {
  las.records.push_back(las_record("laszip encoded", 22204, text_of(laz::layout_record(layout))));
  std::string bytes = las.bytes();
  bytes.resize(bytes.size() - las.points.size() * las.points[0].size());
  put(bytes, 104, static_cast<std::uint8_t>(las.format | 0x80));
  return bytes;
}

std::string laz_points(const laz::Layout& layout, const std::string& records,
                       const std::vector<std::uint64_t>& chunk_points, std::size_t offset) {
  const std::span bytes = std::as_bytes(std::span(records));
  return text_of(laz_point_data(layout, bytes, chunk_points, offset));
}

std::string laz_file(const LasFile& las, const laz::Layout& layout,
                     const std::vector<std::uint64_t>& chunk_points) {
  std::string head = laz_head(las, layout), points;
  for (const std::string& point : las.points) points += point;
  return head + laz_points(layout, points, chunk_points, head.size());
}

}  // namespace lacuna::test
