// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/number.hpp"
#include "io/read/laz/items.hpp"
#include "io/read/laz/predicted_values.hpp"

#include <array>
#include <optional>

namespace lacuna::io::laz {
namespace {

// POINT10, version 2: the 20 bytes that point formats 0 to 3 begin with (LAZ, "POINT10").

class Point10 {
 public:
  // `first`: the chunk's first point, which is not compressed.
  explicit Point10(const std::byte* first);

  // Decodes the next point to `item`, or encodes it from there.
  void code(ArithmeticDecoder& decoder, std::byte* item);
  void code(ArithmeticEncoder& encoder, const std::byte* item);

 private:
  struct Fields {
    std::int32_t x, y, z;
    std::uint16_t intensity;
    std::uint8_t returns;  // return number, number of returns, scan direction and edge of flight line
    std::uint8_t classification;
    std::uint8_t scan_angle;
    std::uint8_t user_data;
    std::uint16_t point_source;
  };
  static_assert(sizeof(Fields) == 20);

  unsigned changes_to(const Fields& now) const;
  template <class Coder>
  void code_fields(Coder& coder, Fields& now);

  Fields last_;
  std::array<std::uint16_t, 16> last_intensities_{};       // by context of return numbers
  std::array<StreamingMedian, 16> x_medians_, y_medians_;  // by context of return numbers
  std::array<std::int32_t, 8> last_heights_{};             // by return level

  SymbolModel<64> changed_;
  ModelByValue<256, 256> returns_;
  IntegerCoder<16, 4> intensity_;
  ModelByValue<256, 256> classification_;
  std::array<SymbolModel<256>, 2> scan_angle_;
  ModelByValue<256, 256> user_data_;
  IntegerCoder<16> point_source_;
  IntegerCoder<32, 2> dx_;
  IntegerCoder<32, 22> dy_;
  IntegerCoder<32, 20> z_;
};

// By number of returns, then by return number: possible pairs have a context of their own up to five returns.
constexpr std::uint8_t kReturnContext[8][8] = {
    {15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},    {13, 1, 2, 4, 7, 11, 11, 10},
    {12, 3, 4, 5, 8, 12, 12, 11},    {11, 6, 7, 8, 9, 13, 13, 12},   {10, 10, 11, 12, 13, 14, 14, 13},
    {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15},
};

unsigned context_of(std::uint8_t returns) {
  return kReturnContext[returns >> 3 & 7][returns & 7];
}

// Bits of the symbol that says which fields differ from the last point's.
constexpr unsigned kPointSource = 1, kUserData = 2, kScanAngle = 4, kClassification = 8, kIntensity = 16,
                   kReturns = 32;

Point10::Point10(const std::byte* first) : last_(load<Fields>(first)) {}

void Point10::code(ArithmeticDecoder& decoder, std::byte* item) {
  Fields now = last_;
  code_fields(decoder, now);
  store(item, now);
}

void Point10::code(ArithmeticEncoder& encoder, const std::byte* item) {
  Fields now = load<Fields>(item);
  code_fields(encoder, now);
}

unsigned Point10::changes_to(const Fields& now) const {
  return (now.returns != last_.returns ? kReturns : 0) |
         (now.intensity != last_intensities_[context_of(now.returns)] ? kIntensity : 0) |
         (now.classification != last_.classification ? kClassification : 0) |
         (now.scan_angle != last_.scan_angle ? kScanAngle : 0) |
         (now.user_data != last_.user_data ? kUserData : 0) |
         (now.point_source != last_.point_source ? kPointSource : 0);
}

// `now` is the next point. A decoder changes it from the last point to that.
template <class Coder>
void Point10::code_fields(Coder& coder, Fields& now) {
  unsigned changed = Coder::kEncodes ? changes_to(now) : 0;
  coder.code(changed_, changed);
  if (changed & kReturns) coder.code(returns_[last_.returns], now.returns);
  const unsigned r = now.returns & 7, n = now.returns >> 3 & 7;
  const unsigned context = context_of(now.returns);

  std::uint16_t& intensity = last_intensities_[context];
  if (changed & kIntensity) {
    intensity_.code(coder, intensity, now.intensity, std::min(context, 3u));
    intensity = now.intensity;
  }
  now.intensity = intensity;
  if (changed & kClassification) coder.code(classification_[last_.classification], now.classification);
  if (changed & kScanAngle) {
    const unsigned direction = now.returns >> 6 & 1;
    auto turn = static_cast<std::uint8_t>(now.scan_angle - last_.scan_angle);
    coder.code(scan_angle_[direction], turn);
    now.scan_angle = static_cast<std::uint8_t>(last_.scan_angle + turn);
  }
  if (changed & kUserData) coder.code(user_data_[last_.user_data], now.user_data);
  if (changed & kPointSource) point_source_.code(coder, last_.point_source, now.point_source);

  const bool only = n == 1;
  std::int32_t dx = wrapped_difference(now.x, last_.x), dy = wrapped_difference(now.y, last_.y);
  dx_.code(coder, x_medians_[context].middle(), dx, only);
  x_medians_[context].add(dx);
  now.x = wrapped_sum(last_.x, dx);
  dy_.code(coder, y_medians_[context].middle(), dy, k_context(dx_.k(), kLargestYContext, only));
  y_medians_[context].add(dy);
  now.y = wrapped_sum(last_.y, dy);
  std::int32_t& height = last_heights_[return_level(n, r)];
  z_.code(coder, height, now.z, k_context((dx_.k() + dy_.k()) / 2, kLargestZContext, only));
  height = now.z;
  last_ = now;
}

// The items of version 2. `code` decodes the next item, or encodes it.
class GpsTime11 {
 public:
  explicit GpsTime11(const std::byte* first) : coder_(load<std::uint64_t>(first)) {}
  void code(ArithmeticDecoder& decoder, std::byte* item) {
    std::uint64_t time;
    coder_.code(decoder, time);
    store(item, time);
  }
  void code(ArithmeticEncoder& encoder, const std::byte* item) {
    coder_.code(encoder, load<std::uint64_t>(item));
  }

 private:
  GpsTimeCoder<GpsTimeCodes::kGpsTime11> coder_;
};

// An item that its models code by the last one.
template <class Value, class Models>
class ItemByLast {
 public:
  explicit ItemByLast(const std::byte* first) : last_(load<Value>(first)) {}
  void code(ArithmeticDecoder& decoder, std::byte* item) {
    models_.code(decoder, Value(last_), last_);
    store(item, last_);
  }
  void code(ArithmeticEncoder& encoder, const std::byte* item) {
    const Value before = last_;
    last_ = load<Value>(item);
    models_.code(encoder, before, last_);
  }

 private:
  Value last_;
  Models models_;
};
using Rgb12 = ItemByLast<Rgb, RgbModels>;
using Wavepacket13 = ItemByLast<Wavepacket, WavepacketModels>;

// BYTE (LAZ, "BYTE"): the difference of each byte to the same byte of the last point.
class ExtraBytes {
 public:
  ExtraBytes(const std::byte* first, std::size_t count) : last_(first, first + count), models_(count) {}
  template <class Coder, class Byte>
  void code(Coder& coder, Byte* item) {
    for (std::size_t i = 0; i < last_.size(); ++i) code_extra_byte(coder, models_[i], last_[i], item[i]);
  }

 private:
  std::vector<std::byte> last_;
  std::vector<SymbolModel<256>> models_;
};

// The items of a record; items that the layout does not have are empty. The order is as in parse_layout().
struct Items {
  std::optional<Point10> point;
  std::optional<GpsTime11> gps_time;
  std::optional<Rgb12> rgb;
  std::optional<Wavepacket13> wavepacket;
  std::optional<ExtraBytes> extra_bytes;
  std::size_t gps_time_at = 0, rgb_at = 0, wavepacket_at = 0, extra_bytes_at = 0;

  Items(const Layout& layout, const std::byte* first) {
    std::size_t at = 0;
    for (const Item& item : layout.items) {
      switch (item.type) {
        case item_type::kPoint10:
          point.emplace(first + at);
          break;
        case item_type::kGpsTime11:
          gps_time.emplace(first + at);
          gps_time_at = at;
          break;
        case item_type::kRgb12:
          rgb.emplace(first + at);
          rgb_at = at;
          break;
        case item_type::kWavepacket13:
          wavepacket.emplace(first + at);
          wavepacket_at = at;
          break;
        default:
          extra_bytes.emplace(first + at, item.size);
          extra_bytes_at = at;
      }
      at += item.size;
    }
  }

  template <class Coder, class Byte>
  void code(Coder& coder, Byte* record) {
    point->code(coder, record);
    if (gps_time) gps_time->code(coder, record + gps_time_at);
    if (rgb) rgb->code(coder, record + rgb_at);
    if (wavepacket) wavepacket->code(coder, record + wavepacket_at);
    if (extra_bytes) extra_bytes->code(coder, record + extra_bytes_at);
  }
};

class PointwiseDecoder final : public RecordDecoder {
 public:
  PointwiseDecoder(const Layout& layout, const ChunkBytes& bytes, std::span<const std::byte> first)
      : record_bytes_(first.size()),
        items_(layout, first.data()),
        decoder_(bytes, record_bytes_, bytes.size()) {}

  void decode(std::span<std::byte> records) override {
    for (std::size_t at = 0; at < records.size(); at += record_bytes_)
      items_.code(decoder_, records.data() + at);
  }

  bool has_other_than(std::uint64_t) const override { return !decoder_.is_at_end(); }

 private:
  std::size_t record_bytes_;
  Items items_;
  ArithmeticDecoder decoder_;
};

}  // namespace

std::unique_ptr<RecordDecoder> pointwise_decoder(const Layout& layout, const ChunkBytes& bytes,
                                                 std::span<const std::byte> first) {
  return std::make_unique<PointwiseDecoder>(layout, bytes, first);
}

std::vector<std::byte> pointwise_chunk(const Layout& layout, std::span<const std::byte> records) {
  const std::size_t record_bytes = layout.record_bytes();
  ArithmeticEncoder encoder;
  const auto items = std::make_unique<Items>(layout, records.data());
  for (std::size_t at = record_bytes; at < records.size(); at += record_bytes)
    items->code(encoder, records.data() + at);

  const auto first = records.first(record_bytes);
  std::vector<std::byte> chunk(first.begin(), first.end());
  const std::vector<std::byte> rest = encoder.finish();
  chunk.insert(chunk.end(), rest.begin(), rest.end());
  return chunk;
}

}  // namespace lacuna::io::laz
