// SPDX-License-Identifier: Apache-2.0
#include "io/laz/pointwise.hpp"

#include "io/files/little_endian.hpp"
#include "io/laz/gps_time.hpp"
#include "io/laz/point10.hpp"
#include "io/laz/rgb.hpp"
#include "io/laz/version1.hpp"

#include <algorithm>
#include <cassert>
#include <memory>

namespace lacuna::io::laz {
namespace {

// GPSTIME11, version 2.
class GpsTime11 {
 public:
  explicit GpsTime11(const std::byte* first) : coder_(load<std::uint64_t>(first)) {}
  void decode(ArithmeticDecoder& decoder, std::byte* item) { store(item, coder_.decode(decoder)); }
  void encode(ArithmeticEncoder& encoder, const std::byte* item) {
    coder_.encode(encoder, load<std::uint64_t>(item));
  }

 private:
  GpsTimeCoder<GpsTimeCodes::kGpsTime11> coder_;
};

// RGB12, version 2.
class Rgb12 {
 public:
  explicit Rgb12(const std::byte* first) { std::memcpy(&last_, first, sizeof last_); }
  void decode(ArithmeticDecoder& decoder, std::byte* item) {
    last_ = models_.decode(decoder, last_);
    std::memcpy(item, &last_, sizeof last_);
  }
  void encode(ArithmeticEncoder& encoder, const std::byte* item) {
    const Rgb before = last_;
    std::memcpy(&last_, item, sizeof last_);
    models_.encode(encoder, before, last_);
  }

 private:
  Rgb last_;
  RgbModels models_;
};

// BYTE, version 2 (LAZ, "BYTE"): the difference of each byte to the same byte of the last point.
class ExtraBytes {
 public:
  ExtraBytes(const std::byte* first, std::size_t count) : last_(first, first + count), models_(count) {}
  void decode(ArithmeticDecoder& decoder, std::byte* item) {
    for (std::size_t i = 0; i < last_.size(); ++i) {
      last_[i] = static_cast<std::byte>(std::to_integer<unsigned>(last_[i]) + decoder.symbol(models_[i]));
    }
    std::copy(last_.begin(), last_.end(), item);
  }
  void encode(ArithmeticEncoder& encoder, const std::byte* item) {
    for (std::size_t i = 0; i < last_.size(); ++i) {
      const unsigned now = std::to_integer<unsigned>(item[i]);
      encoder.symbol(models_[i], (now - std::to_integer<unsigned>(last_[i])) & 255);
      last_[i] = item[i];
    }
  }

 private:
  std::vector<std::byte> last_;
  std::vector<SymbolModel<256>> models_;
};

// The items of a record; items that the layout does not have are null. The order is as in parse_layout().
template <class P, class G, class C, class E>
struct Items {
  std::unique_ptr<P> point;
  std::unique_ptr<G> gps_time;
  std::unique_ptr<C> rgb;
  std::unique_ptr<E> extra_bytes;
  std::size_t gps_time_at = 0, rgb_at = 0, extra_bytes_at = 0;

  Items(const Layout& layout, const std::byte* first) {
    std::size_t at = 0;
    for (const Item& item : layout.items) {
      switch (item.type) {
        case item_type::kPoint10:
          point = std::make_unique<P>(first + at);
          break;
        case item_type::kGpsTime11:
          gps_time = std::make_unique<G>(first + at);
          gps_time_at = at;
          break;
        case item_type::kRgb12:
          rgb = std::make_unique<C>(first + at);
          rgb_at = at;
          break;
        default:
          extra_bytes = std::make_unique<E>(first + at, item.size);
          extra_bytes_at = at;
      }
      at += item.size;
    }
  }

  void decode(ArithmeticDecoder& decoder, std::byte* record) {
    point->decode(decoder, record);
    if (gps_time) gps_time->decode(decoder, record + gps_time_at);
    if (rgb) rgb->decode(decoder, record + rgb_at);
    if (extra_bytes) extra_bytes->decode(decoder, record + extra_bytes_at);
  }

  void encode(ArithmeticEncoder& encoder, const std::byte* record) {
    point->encode(encoder, record);
    if (gps_time) gps_time->encode(encoder, record + gps_time_at);
    if (rgb) rgb->encode(encoder, record + rgb_at);
    if (extra_bytes) extra_bytes->encode(encoder, record + extra_bytes_at);
  }
};
using ItemsOfVersion1 = Items<version1::Point10, version1::GpsTime11, version1::Rgb12, version1::ExtraBytes>;
using ItemsOfVersion2 = Items<Point10, GpsTime11, Rgb12, ExtraBytes>;

template <class Items>
class PointwiseDecoder final : public RecordDecoder {
 public:
  PointwiseDecoder(const Layout& layout, const ChunkBytes& bytes, std::span<const std::byte> first)
      : record_bytes_(first.size()),
        items_(layout, first.data()),
        decoder_(bytes, record_bytes_, bytes.size()) {}

  void decode(std::span<std::byte> records) override {
    for (std::size_t at = 0; at < records.size(); at += record_bytes_)
      items_.decode(decoder_, records.data() + at);
  }

 private:
  std::size_t record_bytes_;
  Items items_;
  ArithmeticDecoder decoder_;
};

}  // namespace

std::unique_ptr<RecordDecoder> pointwise_decoder(const Layout& layout, const ChunkBytes& bytes,
                                                 std::span<const std::byte> first) {
  if (layout.items[0].version == 1)
    return std::make_unique<PointwiseDecoder<ItemsOfVersion1>>(layout, bytes, first);
  return std::make_unique<PointwiseDecoder<ItemsOfVersion2>>(layout, bytes, first);
}

std::vector<std::byte> pointwise_chunk(const Layout& layout, std::span<const std::byte> records) {
  assert(layout.items[0].version == 2);
  const std::size_t record_bytes = layout.record_bytes();
  ArithmeticEncoder encoder;
  ItemsOfVersion2 items(layout, records.data());
  for (std::size_t at = record_bytes; at < records.size(); at += record_bytes)
    items.encode(encoder, records.data() + at);

  const auto first = records.first(record_bytes);
  std::vector<std::byte> chunk(first.begin(), first.end());
  const std::vector<std::byte> rest = encoder.finish();
  chunk.insert(chunk.end(), rest.begin(), rest.end());
  return chunk;
}

}  // namespace lacuna::io::laz
