// SPDX-License-Identifier: Apache-2.0
#include "io/laz/pointwise.hpp"

#include "io/laz/gps_time.hpp"
#include "io/laz/point10.hpp"
#include "io/laz/rgb.hpp"
#include "io/laz/version1.hpp"
#include "io/little_endian.hpp"

#include <algorithm>
#include <memory>

namespace lacuna::io::laz {
namespace {

// GPSTIME11, version 2.
class GpsTime11 {
 public:
  explicit GpsTime11(const std::byte* first) : decoder_(load<std::uint64_t>(first)) {}
  void decode(ArithmeticDecoder& decoder, std::byte* item) { store(item, decoder_.decode(decoder)); }

 private:
  GpsTimeDecoder<GpsTimeCodes::kGpsTime11> decoder_;
};

// RGB12, version 2.
class Rgb12 {
 public:
  explicit Rgb12(const std::byte* first) { std::memcpy(&last_, first, sizeof last_); }
  void decode(ArithmeticDecoder& decoder, std::byte* item) {
    last_ = models_.decode(decoder, last_);
    std::memcpy(item, &last_, sizeof last_);
  }

 private:
  Rgb last_;
  RgbModels models_;
};

// BYTE, version 2 (LAZ, "BYTE"): the difference of each byte to that of the last point.
class ExtraBytes {
 public:
  ExtraBytes(const std::byte* first, std::size_t count) : last_(first, first + count), models_(count) {}
  void decode(ArithmeticDecoder& decoder, std::byte* item) {
    for (std::size_t i = 0; i < last_.size(); ++i) {
      last_[i] = static_cast<std::byte>(std::to_integer<unsigned>(last_[i]) + decoder.symbol(models_[i]));
    }
    std::copy(last_.begin(), last_.end(), item);
  }

 private:
  std::vector<std::byte> last_;
  std::vector<SymbolModel<256>> models_;
};

// The items of a record; those that the layout does not have are null. The order is that of parse_layout().
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
};

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
  using Version1 = Items<version1::Point10, version1::GpsTime11, version1::Rgb12, version1::ExtraBytes>;
  using Version2 = Items<Point10, GpsTime11, Rgb12, ExtraBytes>;
  if (layout.items[0].version == 1) return std::make_unique<PointwiseDecoder<Version1>>(layout, bytes, first);
  return std::make_unique<PointwiseDecoder<Version2>>(layout, bytes, first);
}

}  // namespace lacuna::io::laz
