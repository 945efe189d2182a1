// SPDX-License-Identifier: Apache-2.0
#include "io/read/laz/pointwise.hpp"

#include "io/read/files/little_endian.hpp"
#include "io/read/laz/extra_bytes.hpp"
#include "io/read/laz/gps_time.hpp"
#include "io/read/laz/point10.hpp"
#include "io/read/laz/rgb.hpp"
#include "io/read/laz/wavepacket.hpp"

#include <optional>

namespace lacuna::io::laz {
namespace {

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
