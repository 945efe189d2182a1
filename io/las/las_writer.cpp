// SPDX-License-Identifier: Apache-2.0
#include "io/las/las_writer.hpp"

#include "io/las/las_bytes.hpp"
#include "io/las/las_records.hpp"
#include "io/laz/laz_encoder.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace lacuna::io {
namespace {

constexpr std::size_t kHeaderBytes = 375;
constexpr std::uint16_t kTimeBit = 1, kTextBit = 16;  // of the global encoding
constexpr int kCompressed = 0x80;                     // of the point format

bool goes_over(const LasRecordPlace& record, const LasOrigin& origin) {
  if (record.user == kLaszip || record.user == "copc") return false;
  if (record.user == kLasProjection && !origin.has_crs) return false;
  return record.user != kLasSpecification || record.number != kLasExtraBytes;
}

// Whether `crs` is written, and not the records of the origin.
bool is_new_crs(const std::optional<LasOrigin>& origin) {
  return !origin || !origin->has_crs;
}

// Whether the coordinate reference system of a new file of these points is well-known text. Formats 6 to 10
// require it, with a text or without (LAS 1.4 R15, 2.4). Keys of GeoTIFF alone stay what they are.
bool has_text(const std::optional<LasOrigin>& origin, const LasForm& form, std::string_view crs) {
  const bool is_extended = is_extended_format(form.point_format);
  if (is_new_crs(origin)) return crs.empty() ? is_extended : !crs.starts_with("EPSG:");
  if (!is_extended) return false;
  bool has_keys = false;
  for (const auto* records : {&origin->header.records, &origin->header.extended}) {
    for (const LasRecordPlace& record : *records) {
      if (record.user != kLasProjection || !goes_over(record, *origin)) continue;
      if (record.number == kLasWellKnownText) return true;
      has_keys = has_keys || record.number == kLasGeoKeys;
    }
  }
  return !has_keys;
}

// What the form changes of the origin's global encoding.
std::uint16_t encoding_of(std::uint16_t given, const std::optional<LasOrigin>& origin, const LasForm& form,
                          std::string_view crs) {
  unsigned encoding = given & ~unsigned{kTimeBit};
  if (form.has_standard_time) encoding |= kTimeBit;
  const bool is_widened =
      origin && is_extended_format(form.point_format) && !is_extended_format(origin->header.point_format);
  if (is_new_crs(origin)) encoding &= ~unsigned{kTextBit};
  if ((is_widened || is_new_crs(origin)) && has_text(origin, form, crs)) encoding |= kTextBit;
  return static_cast<std::uint16_t>(encoding);
}

// The header of the origin as LAS 1.4 has it.
std::string header_of(const std::optional<LasOrigin>& origin, const LasForm& form, std::string_view crs) {
  std::string header(kHeaderBytes, '\0');
  if (origin) {
    constexpr std::array<std::size_t, 5> kBytes = {227, 227, 227, 235, 375};
    const LasHeader& from = origin->header;
    const std::size_t bytes = kBytes.at(static_cast<std::size_t>(from.minor));
    std::memcpy(header.data(), from.bytes.data(), bytes);
    // Reserved before these versions.
    if (from.minor < 1) put_at<std::uint16_t>(header, 4, 0);
    if (from.minor < 2) put_at<std::uint16_t>(header, 6, 0);
    header.append(reinterpret_cast<const char*>(from.bytes.data()) + bytes, from.bytes.size() - bytes);
  } else {
    put_text(header, 0, 4, "LASF");
    put_text(header, 26, 32, "OTHER");
  }
  put_at(header, 6, encoding_of(value_at<std::uint16_t>(header, 6), origin, form, crs));
  put_at<std::uint8_t>(header, 24, 1);
  put_at<std::uint8_t>(header, 25, 4);
  put_text(header, kLasSoftwareAt, 32, std::string(kLasSoftware) + LACUNA_VERSION);
  put_at(header, 94, static_cast<std::uint16_t>(header.size()));
  put_at(header, 104, static_cast<std::uint8_t>(form.point_format));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put_at(header, 131 + 8 * axis, form.scale[axis]);
    put_at(header, 155 + 8 * axis, form.offset[axis]);
  }
  return header;
}

}  // namespace

LasWriter::LasWriter(OutputFile& out, LasForm form, std::span<const LasExtraBytes> results,
                     std::optional<LasOrigin> origin, std::string_view crs,
                     std::optional<LasCompression> compression)
    : out_(out), form_(std::move(form)), origin_(std::move(origin)), record_bytes_(form_.record_bytes) {
  min_.fill(std::numeric_limits<std::int32_t>::max());
  max_.fill(std::numeric_limits<std::int32_t>::min());
  std::vector<LasExtraBytes> extra;
  for (const LasExtraField& field : form_.extra) extra.push_back(field.what);
  for (const LasExtraBytes& result : results) {
    extra.push_back(result);
    record_bytes_ += las_extra_size(result);
  }
  header_ = header_of(origin_, form_, crs);
  if (compression) put_at(header_, 104, static_cast<std::uint8_t>(form_.point_format | kCompressed));
  put_at(header_, 105, static_cast<std::uint16_t>(record_bytes_));
  out_.write(header_);
  written_ = header_.size();
  write_records(extra, crs, compression);
  put_at(header_, 96, static_cast<std::uint32_t>(written_));
  put_at(header_, 100, records_);
  points_out_ = las_points_writer(out_, written_, std::move(compression));
}

void LasWriter::write_records(const std::vector<LasExtraBytes>& extra, std::string_view crs,
                              const std::optional<LasCompression>& compression) {
  const auto write = [&](std::string_view user, std::uint16_t number, std::string_view data,
                         std::string_view description) {
    out_.write(las_record_head(false, user, number, data.size(), description));
    out_.write(data);
    written_ += kLasRecordHead + data.size();
    ++records_;
  };
  if (origin_) {
    for (const LasRecordPlace& record : origin_->header.records) {
      if (!goes_over(record, *origin_)) continue;
      written_ += copy_las_record(origin_->file, record, out_);
      ++records_;
    }
  }
  if (is_new_crs(origin_) && crs.starts_with("EPSG:")) {
    if (const std::string keys = geo_keys(crs); !keys.empty())
      write(kLasProjection, kLasGeoKeys, keys, "GeoTIFF GeoKeyDirectoryTag");
  } else if (is_new_crs(origin_) && !crs.empty()) {
    const std::string text = std::string(crs) + '\0';
    if (text.size() <= kMostLasRecordData) {
      write(kLasProjection, kLasWellKnownText, text, "OGC coordinate system WKT");
    } else {
      long_text_ = text;
    }
  }
  std::string descriptors;
  for (const LasExtraBytes& one : extra)
    descriptors.append(reinterpret_cast<const char*>(one.descriptor.data()), one.descriptor.size());
  if (!extra.empty()) write(kLasSpecification, kLasExtraBytes, descriptors, "Extra Bytes Record");
  if (compression) {
    const std::vector<std::byte> layout = laz::layout_record(compression->layout);
    write(kLaszip, kLaszipLayout, {reinterpret_cast<const char*>(layout.data()), layout.size()}, "LASzip");
  }
}

void LasWriter::put(std::span<const std::byte> records) {
  points_out_->put(records);
  points_ += records.size() / record_bytes_;
  if (origin_ && origin_->has_counts) return;
  const unsigned mask = is_extended_format(form_.point_format) ? 15 : 7;
  for (const std::byte* at = records.data(); at != records.data() + records.size(); at += record_bytes_) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto value = load<std::int32_t>(at + 4 * axis);
      min_[axis] = std::min(min_[axis], value);
      max_[axis] = std::max(max_[axis], value);
    }
    const unsigned number = std::to_integer<unsigned>(at[14]) & mask;
    if (number > 0) ++returns_[number - 1];
  }
}

void LasWriter::write_extended() {
  extended_at_ = written_;
  if (origin_) {
    for (const LasRecordPlace& record : origin_->header.extended) {
      if (!goes_over(record, *origin_)) continue;
      if (record.at == origin_->header.waveforms_at) waveforms_at_ = written_;
      written_ += copy_las_record(origin_->file, record, out_);
      ++extended_;
    }
  }
  if (!long_text_.empty()) {
    out_.write(las_record_head(true, kLasProjection, kLasWellKnownText, long_text_.size(),
                               "OGC coordinate system WKT"));
    out_.write(long_text_);
    ++extended_;
  }
}

void LasWriter::complete_header() {
  put_at(header_, 227, waveforms_at_);
  put_at(header_, 235, extended_ > 0 ? extended_at_ : std::uint64_t{0});
  put_at(header_, 243, extended_);
  put_at(header_, 247, points_);
  const bool is_old = origin_ && origin_->has_counts && origin_->header.minor < 4;
  if (is_old) {
    for (std::size_t i = 0; i < 5; ++i)
      put_at(header_, 255 + 8 * i, std::uint64_t{value_at<std::uint32_t>(header_, 111 + 4 * i)});
  }
  if (origin_ && origin_->has_counts) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto place = [&](std::int32_t stored) { return stored * form_.scale[axis] + form_.offset[axis]; };
    const double first = points_ > 0 ? place(min_[axis]) : 0, last = points_ > 0 ? place(max_[axis]) : 0;
    put_at(header_, 179 + 16 * axis, std::max(first, last));  // a scale may be negative
    put_at(header_, 187 + 16 * axis, std::min(first, last));
  }
  const bool has_legacy =
      !is_extended_format(form_.point_format) && points_ <= std::numeric_limits<std::uint32_t>::max();
  put_at(header_, 107, static_cast<std::uint32_t>(has_legacy ? points_ : 0));
  for (std::size_t i = 0; i < returns_.size(); ++i) {
    put_at(header_, 255 + 8 * i, returns_[i]);
    if (i < 5) put_at(header_, 111 + 4 * i, static_cast<std::uint32_t>(has_legacy ? returns_[i] : 0));
  }
}

void LasWriter::finish() {
  written_ += points_out_->finish();
  write_extended();
  complete_header();
  out_.overwrite_start(header_);
}

}  // namespace lacuna::io
