// SPDX-License-Identifier: Apache-2.0
#include "engine/run/parallel.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/las/las_header.hpp"
#include "io/read/las/las_points.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/readers.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

// Places of the fields of each point format in a record (ASPRS LAS specification 1.4 R15, section 2.6).

struct LasField {
  const char* name;  // of its column
  Scalar type;       // of its column
  std::size_t offset;
  std::uint8_t shift = 0, bits = 0;  // of a byte; bits 0: the whole value
  std::uint8_t stored = 0;           // type of extra bytes as which it is stored, if that is another
  double scale = 1;                  // of the stored value
};

// Formats 6 to 10 have larger fields for returns, class and scan angle.
bool is_extended_format(int format) {
  return format >= 6;
}

// The first byte of each group of fields that only some formats have.
struct LasGroups {
  std::optional<std::size_t> gps_time, colour, infrared, waveform;
};

LasGroups las_groups(int format) {
  LasGroups groups;
  std::size_t next = 20;
  if (is_extended_format(format)) {
    groups.gps_time = 22;
    next = 30;
  } else if (format == 1 || format >= 3) {
    groups.gps_time = next;
    next += 8;
  }
  if (format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10) {
    groups.colour = next;
    next += 6;
  }
  if (format == 8 || format == 10) {
    groups.infrared = next;
    next += 2;
  }
  if (format == 4 || format == 5 || format == 9 || format == 10) groups.waveform = next;
  return groups;
}

// Returns all fields but the coordinates, which are the first twelve bytes, in the order of their columns.
// `format` is 0 to 10.
std::vector<LasField> las_fields(int format) {
  std::vector<LasField> fields;
  const auto bits = [&](const char* name, std::size_t offset, std::uint8_t shift, std::uint8_t count) {
    fields.push_back({.name = name, .type = Scalar::kUint8, .offset = offset, .shift = shift, .bits = count});
  };
  const auto whole = [&](const char* name, Scalar type, std::size_t offset) {
    fields.push_back({.name = name, .type = type, .offset = offset});
  };
  const LasGroups groups = las_groups(format);
  whole("intensity", Scalar::kUint16, 12);
  if (!is_extended_format(format)) {
    bits("return_number", 14, 0, 3);
    bits("number_of_returns", 14, 3, 3);
    bits("scan_direction_flag", 14, 6, 1);
    bits("edge_of_flight_line", 14, 7, 1);
    bits("classification", 15, 0, 5);
    bits("synthetic", 15, 5, 1);
    bits("key_point", 15, 6, 1);
    bits("withheld", 15, 7, 1);
    whole("scan_angle", Scalar::kInt8, 16);
    whole("user_data", Scalar::kUint8, 17);
    whole("point_source_id", Scalar::kUint16, 18);
  } else {
    bits("return_number", 14, 0, 4);
    bits("number_of_returns", 14, 4, 4);
    bits("synthetic", 15, 0, 1);
    bits("key_point", 15, 1, 1);
    bits("withheld", 15, 2, 1);
    bits("overlap", 15, 3, 1);
    bits("scanner_channel", 15, 4, 2);
    bits("scan_direction_flag", 15, 6, 1);
    bits("edge_of_flight_line", 15, 7, 1);
    whole("classification", Scalar::kUint8, 16);
    whole("user_data", Scalar::kUint8, 17);
    fields.push_back(
        {.name = "scan_angle", .type = Scalar::kFloat32, .offset = 18, .stored = 4, .scale = 0.006});
    whole("point_source_id", Scalar::kUint16, 20);
  }
  if (groups.gps_time) whole("gps_time", Scalar::kFloat64, *groups.gps_time);
  if (groups.colour) {
    whole("red", Scalar::kUint16, *groups.colour);
    whole("green", Scalar::kUint16, *groups.colour + 2);
    whole("blue", Scalar::kUint16, *groups.colour + 4);
  }
  if (groups.infrared) whole("nir", Scalar::kUint16, *groups.infrared);
  if (groups.waveform) {
    const std::size_t at = *groups.waveform;
    whole("wave_packet_descriptor", Scalar::kUint8, at);
    fields.push_back({.name = "wave_packet_offset", .type = Scalar::kFloat64, .offset = at + 1, .stored = 7});
    whole("wave_packet_bytes", Scalar::kUint32, at + 9);
    whole("wave_return_location", Scalar::kFloat32, at + 13);
    whole("wave_x", Scalar::kFloat32, at + 17);
    whole("wave_y", Scalar::kFloat32, at + 21);
    whole("wave_z", Scalar::kFloat32, at + 25);
  }
  return fields;
}

// The columns of LAS points, and raw records unpacked to rows.

// The columns are every field of the point format, then the extra bytes; x, y and z are doubles in units of
// the scan. Values of extra bytes with a scale or offset, and integers of eight bytes, are doubles. So are
// integers of which a value means no data; that value is NaN. Scan angles are in degrees. Bytes that the
// header does not describe are the columns extra_0, extra_1 and so on. Names differ: a number is added to a
// second one.
class LasColumns {
 public:
  explicit LasColumns(const LasHeader& header);

  const RowLayout& layout() const { return layout_; }
  // `records`: raw ones, one after the other; `rows`: as many of the layout.
  void unpack(std::span<const std::byte> records, std::byte* rows) const;

 private:
  // The place of a column's value in a record, and its conversion.
  struct Source {
    enum class Kind : std::uint8_t { kCoordinate, kBits, kCopy, kScaled } kind;
    std::size_t offset;
    std::uint8_t shift = 0, mask = 0xff;  // of bits
    std::uint8_t stored = 0;              // type of extra bytes, 1 to 10
    double scale = 1, added = 0;
    std::optional<double> no_data = std::nullopt;  // the stored value that becomes NaN
  };
  void add(std::string name, Scalar type, Source source);
  void add_extra(const LasExtraBytes& extra, std::size_t& offset);

  std::size_t record_bytes_;
  RowLayout layout_;
  std::vector<Source> sources_;                         // of each column
  std::unordered_map<std::string, std::size_t> names_;  // of columns, and how many were given each
};

constexpr std::uint8_t kUint64 = 7, kInt64 = 8;  // types of extra bytes

LasColumns::LasColumns(const LasHeader& header) : record_bytes_(header.record_bytes) {
  using Kind = Source::Kind;
  const char* const axes[] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add(axes[axis], Scalar::kFloat64,
        {.kind = Kind::kCoordinate,
         .offset = 4 * axis,
         .scale = header.scale[axis],
         .added = header.offset[axis]});
  }
  for (const LasField& field : las_fields(header.point_format)) {
    if (field.stored > 0) {
      add(field.name, field.type,
          {.kind = Kind::kScaled, .offset = field.offset, .stored = field.stored, .scale = field.scale});
    } else if (field.bits > 0) {
      add(field.name, field.type,
          {.kind = Kind::kBits,
           .offset = field.offset,
           .shift = field.shift,
           .mask = static_cast<std::uint8_t>((1u << field.bits) - 1)});
    } else {
      add(field.name, field.type, {.kind = Kind::kCopy, .offset = field.offset});
    }
  }
  std::size_t next = las_point_bytes(header.point_format);
  for (const LasExtraBytes& extra : header.extra_bytes) add_extra(extra, next);
  for (std::size_t i = 0; next < record_bytes_; ++next, ++i)
    add("extra_" + std::to_string(i), Scalar::kUint8, {.kind = Kind::kCopy, .offset = next});
}

void LasColumns::add(std::string name, Scalar type, Source source) {
  const std::string given = property_name(name);
  name = given;
  while (!names_.emplace(name, 1).second) name = given + "_" + std::to_string(++names_[given]);
  layout_.properties.push_back({.name = std::move(name), .type = type, .offset = layout_.stride});
  layout_.stride += size_of(type);
  sources_.push_back(source);
}

// Descriptors beyond the record's end are left out.
void LasColumns::add_extra(const LasExtraBytes& extra, std::size_t& offset) {
  using Kind = Source::Kind;
  if (extra.type > 30) return;
  const bool is_typed = extra.type > 0;
  const std::uint8_t type = is_typed ? static_cast<std::uint8_t>((extra.type - 1) % 10 + 1) : 1;
  const std::size_t values = is_typed ? (extra.type - 1u) / 10 + 1 : extra.options;
  const std::size_t bytes = las_extra_type(type).bytes;
  for (std::size_t i = 0; i < values && offset + bytes <= record_bytes_; ++i, offset += bytes) {
    const std::string given = extra.name.empty() ? "extra" : extra.name;
    const std::string name = values > 1 ? given + "_" + std::to_string(i) : given;
    const bool is_scaled = extra.scale != 1 || extra.offset != 0 || type == kUint64 || type == kInt64;
    const std::optional<double> no_data = las_no_data(extra, i);
    const Scalar kept = las_extra_type(type).kept;
    if (is_scaled || no_data) {
      add(name, is_scaled || is_integer(kept) ? Scalar::kFloat64 : kept,
          {.kind = Kind::kScaled,
           .offset = offset,
           .stored = type,
           .scale = extra.scale,
           .added = extra.offset,
           .no_data = no_data});
    } else {
      add(name, kept, {.kind = Kind::kCopy, .offset = offset});
    }
  }
}

void LasColumns::unpack(std::span<const std::byte> records, std::byte* rows) const {
  constexpr std::size_t kTogether = 512;  // rows that stay in the cache while column after column is filled
  const std::size_t count = records.size() / record_bytes_;
  for (std::size_t first = 0; first < count; first += kTogether) {
    const std::size_t together = std::min(kTogether, count - first);
    for (std::size_t column = 0; column < sources_.size(); ++column) {
      const Source& source = sources_[column];
      const std::byte* from = &records[first * record_bytes_] + source.offset;
      std::byte* to = rows + first * layout_.stride + layout_.properties[column].offset;
      const auto fill = [&](auto&& value_of) {
        for (std::size_t i = 0; i < together; ++i, from += record_bytes_, to += layout_.stride) {
          const auto value = value_of(from);
          std::memcpy(to, &value, sizeof value);
        }
      };
      switch (source.kind) {
        case Source::Kind::kCoordinate:
          fill([&](const std::byte* at) {
            return static_cast<double>(load<std::int32_t>(at)) * source.scale + source.added;
          });
          break;
        case Source::Kind::kBits:
          fill([&](const std::byte* at) {
            return static_cast<std::uint8_t>((std::to_integer<unsigned>(*at) >> source.shift) & source.mask);
          });
          break;
        case Source::Kind::kCopy:
          with_type(layout_.properties[column].type,
                    [&](auto zero) { fill([](const std::byte* at) { return load<decltype(zero)>(at); }); });
          break;
        case Source::Kind::kScaled:
          const auto value_of = [&](const std::byte* at) {
            const double stored = load_las_value(source.stored, at);
            return stored == source.no_data ? std::numeric_limits<double>::quiet_NaN()
                                            : stored * source.scale + source.added;
          };
          if (layout_.properties[column].type == Scalar::kFloat32) {
            fill([&](const std::byte* at) { return nearest_float(value_of(at)); });
          } else {
            fill(value_of);
          }
          break;
      }
    }
  }
}

// Returns the bytes of points and of nothing else: up to the records behind them.
std::uint64_t point_bytes(const InputFile& in, const LasHeader& header) {
  std::uint64_t end = in.position() + in.remaining();
  for (const LasRecordExtent& record : header.extended) {
    if (record.at >= header.points_at) end = std::min(end, record.at);
  }
  return end - header.points_at;
}

// Returns the header with the number of points that holds. Throws `Error` where the file has others and
// nobody says which number to trust.
LasHeader counted_header(InputFile& in, Trust trust) {
  LasHeader header = read_las_header(in);
  const std::uint64_t bytes = point_bytes(in, header);
  const auto fail = [&](const std::string& found) {
    in.fail_at_byte(107, "the header counts " + std::to_string(header.points) + " points, but " + found);
  };
  if (header.is_compressed) {
    constexpr std::uint64_t kTablePlace = 8;
    if (header.points == 0 && bytes > kTablePlace && trust != Trust::kHeader)
      fail(
          "compressed points follow; --trust header reads none, and `laszip` or `lasinfo -repair` count "
          "them");
    return header;
  }
  const std::uint64_t records = bytes / header.record_bytes;
  if (records == header.points || trust == Trust::kHeader) return header;
  if (trust == Trust::kNeither)
    fail(std::to_string(records) + " whole ones of " + std::to_string(header.record_bytes) +
         " bytes follow; --trust file reads these" +
         (records > header.points ? ", --trust header the others" : ""));
  header.points = records;
  return header;
}

class LasReader final : public ScanReader {
 public:
  LasReader(const std::filesystem::path& file, const ReadOptions& options)
      : in_(file),
        header_(counted_header(in_, options.trust)),
        points_(las_points(in_, header_, options.trust, options.memory)),
        columns_(header_),
        left_(header_.points) {}

  std::string format() const override {
    return (header_.is_compressed ? "LAZ 1." : "LAS 1.") + std::to_string(header_.minor) + ", point format " +
           std::to_string(header_.point_format);
  }
  const RowLayout& layout() const override { return columns_.layout(); }
  std::optional<std::uint64_t> expected_rows() const override { return header_.points; }
  bool is_slow() const override { return header_.is_compressed; }
  bool has_noise_classes() const override { return true; }
  std::string crs() const override { return header_.crs.text(); }
  std::string other_crs() const override { return header_.crs.other_text(); }
  std::vector<ReaderNote> notes() const override {
    return {{.count = header_.extra_records,
             .thing = "record",
             .what = " of extra bytes, which are together longer than those of a point; the last one holds "
                     "alone, and its values may be others"}};
  }
  bool is_geographic() const override { return header_.crs.is_geographic(); }
  std::string length_unit() const override { return header_.crs.length_unit(); }
  std::string other_unit() const override { return header_.crs.other_unit(); }
  std::string vertical_unit() const override { return header_.crs.vertical_unit(); }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    assert(max_rows > 0);
    const std::size_t fitting = kBatchBytes / std::max<std::size_t>(layout().stride, header_.record_bytes);
    batch.count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, std::min(max_rows, fitting)));
    batch.bytes.resize(batch.count * layout().stride);
    if (batch.count == 0) return false;
    records_.resize(batch.count * header_.record_bytes);
    points_->read(records_);
    unpack(batch);
    left_ -= batch.count;
    return true;
  }

 private:
  void unpack(RowBatch& batch) const {
    constexpr std::size_t kTogether = 4096;  // rows
    for_each_here((batch.count + kTogether - 1) / kTogether, [&](std::size_t i) {
      const std::size_t first = i * kTogether, count = std::min(kTogether, batch.count - first);
      columns_.unpack(std::span(records_).subspan(first * header_.record_bytes, count * header_.record_bytes),
                      batch.bytes.data() + first * layout().stride);
    });
  }

  InputFile in_;
  LasHeader header_;
  std::unique_ptr<LasPoints> points_;
  LasColumns columns_;
  std::uint64_t left_;  // points not yet read
  std::vector<std::byte> records_;
};

}  // namespace

bool looks_like_las(const FileStart& start) {
  return start.first_bytes.starts_with("LASF");
}

std::unique_ptr<ScanReader> open_las(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<LasReader>(file, options);
}

}  // namespace lacuna::io
