// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_writer.hpp"

#include "io/read/las/las_header.hpp"
#include "io/read/laz/laz.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace lacuna::io {
namespace {

constexpr int kCompressed = 0x80;  // of the point format

bool goes_over(const LasRecordExtent& record) {
  if (record.user == kLaszip || record.user == "copc") return false;
  return record.user != kLasSpecification || record.number != kLasExtraBytes;
}

// Returns the header as LAS 1.4 has it.
std::string header_of(const LasHeader& from, std::size_t record_bytes) {
  std::string header(kLasHeaderBytes[4], '\0');
  const std::size_t bytes =
      kLasHeaderBytes.at(std::min(static_cast<std::size_t>(from.minor), std::size_t{4}));
  std::memcpy(header.data(), from.bytes.data(), bytes);
  // These fields were reserved before these versions.
  if (from.minor < 1) put_at<std::uint16_t>(header, 4, 0);
  if (from.minor < 2) put_at<std::uint16_t>(header, 6, 0);
  header.append(reinterpret_cast<const char*>(from.bytes.data()) + bytes, from.bytes.size() - bytes);
  put_at<std::uint8_t>(header, 24, 1);
  put_at<std::uint8_t>(header, 25, 4);
  put_text(header, 58, 32, "Lacuna " LACUNA_VERSION);  // generating software
  put_at(header, 94, static_cast<std::uint16_t>(header.size()));
  put_at(header, 104, static_cast<std::uint8_t>(from.point_format));
  put_at(header, 105, static_cast<std::uint16_t>(record_bytes));
  return header;
}

}  // namespace

LasWriter::LasWriter(OutputFile& out, const std::filesystem::path& file, const LasHeader& from,
                     std::span<const LasExtraBytes> extra, std::size_t record_bytes,
                     std::optional<LasCompression> compression)
    : out_(out),
      file_(file),
      from_(from),
      record_bytes_(record_bytes),
      header_(header_of(from, record_bytes)) {
  if (compression) put_at(header_, 104, static_cast<std::uint8_t>(from.point_format | kCompressed));
  out_.write(header_);
  written_ = header_.size();
  write_records(extra, compression);
  put_at(header_, 96, static_cast<std::uint32_t>(written_));
  put_at(header_, 100, records_);
  points_out_ = las_points_writer(out_, written_, std::move(compression));
}

void LasWriter::write_records(std::span<const LasExtraBytes> extra,
                              const std::optional<LasCompression>& compression) {
  const auto write = [&](std::string_view user, std::uint16_t number, std::string_view data,
                         std::string_view description) {
    out_.write(las_record_head(user, number, static_cast<std::uint16_t>(data.size()), description));
    out_.write(data);
    written_ += kLasRecordHead + data.size();
    ++records_;
  };
  for (const LasRecordExtent& record : from_.records) {
    if (!goes_over(record)) continue;
    written_ += copy_las_record(file_, record, out_);
    ++records_;
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

void LasWriter::put_rows(std::span<const std::byte> records) {
  points_out_->put(records);
  points_ += records.size() / record_bytes_;
  constexpr std::size_t kReturnAt = 14;
  const auto mask = static_cast<std::byte>(from_.point_format < 6 ? 7 : 15);
  for (std::size_t at = kReturnAt; at < records.size(); at += record_bytes_)
    ++of_return_[std::to_integer<std::size_t>(records[at] & mask)];
}

void LasWriter::write_extended() {
  extended_at_ = written_;
  for (const LasRecordExtent& record : from_.extended) {
    if (!goes_over(record)) continue;
    if (record.at == from_.waveforms_at) waveforms_at_ = written_;
    written_ += copy_las_record(file_, record, out_);
    ++extended_;
  }
}

void LasWriter::complete_header() {
  put_at(header_, 227, waveforms_at_);
  put_at(header_, 235, extended_ > 0 ? extended_at_ : std::uint64_t{0});
  put_at(header_, 243, extended_);
  put_at(header_, 247, points_);
  if (points_ != from_.points) return count_anew();
  if (from_.minor >= 4) return;
  // Counts of returns have 64 bits since LAS 1.4.
  for (std::size_t i = 0; i < 5; ++i)
    put_at(header_, 255 + 8 * i, std::uint64_t{value_at<std::uint32_t>(header_, 111 + 4 * i)});
}

// The counts of the other header do not hold. Formats from 6 on have no counts of 32 bits, and neither has a
// file of more points.
void LasWriter::count_anew() {
  const bool has_few = from_.point_format < 6 && points_ <= std::numeric_limits<std::uint32_t>::max();
  const auto few = [&](std::uint64_t count) { return static_cast<std::uint32_t>(has_few ? count : 0); };
  put_at(header_, 107, few(points_));
  for (std::size_t i = 0; i < 15; ++i) put_at(header_, 255 + 8 * i, of_return_[i + 1]);
  for (std::size_t i = 0; i < 5; ++i) put_at(header_, 111 + 4 * i, few(of_return_[i + 1]));
}

void LasWriter::finish() {
  written_ += points_out_->finish();
  write_extended();
  complete_header();
  out_.overwrite_start(header_);
}

}  // namespace lacuna::io
