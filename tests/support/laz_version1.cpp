// SPDX-License-Identifier: Apache-2.0
#include "tests/support/laz_version1.hpp"

#include "io/files/little_endian.hpp"
#include "io/laz/arithmetic_encoder.hpp"
#include "io/laz/contexts.hpp"
#include "io/laz/integer_coder.hpp"
#include "io/laz/wrapped.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace lacuna::test {
namespace {

using namespace io;
using namespace io::laz;

// Version 1 of POINT10, GPSTIME11, RGB12 and BYTE.
struct Version1Encoder {
  const laz::Layout& layout;
  laz::ArithmeticEncoder encoder;
  std::vector<std::byte> last;
  std::vector<std::int32_t> dxs{0, 0, 0}, dys{0, 0, 0};  // the last three
  IntegerCoder<32> dx;
  IntegerCoder<32, 20> dy, z;
  SymbolModel<64> changed;
  IntegerCoder<16> intensity, point_source;
  ModelByValue<256, 256> returns, classification, user_data;
  IntegerCoder<8, 2> scan_angle;
  std::int32_t time_step = 0;
  int extremes = 0;
  SymbolModel<3> time_first;
  SymbolModel<512> time_next;
  IntegerCoder<32, 6> time;
  SymbolModel<64> rgb_changed;
  IntegerCoder<8, 6> rgb;
  IntegerCoder<8> extra_bytes;
  std::vector<SymbolModel<9>> extra_ks;  // one for each byte

  Version1Encoder(const laz::Layout& of, const std::byte* first)
      : layout(of), last(first, first + of.record_bytes()), extra_ks(of.items.back().size) {}

  static std::int32_t median(std::vector<std::int32_t> values) {
    std::sort(values.begin(), values.end());
    return values[1];
  }

  void encode_point(const std::byte* now) {
    const std::byte* before = last.data();
    const auto byte = [](const std::byte* record, std::size_t at) { return load<std::uint8_t>(record + at); };
    const auto coordinate = [](const std::byte* record, std::size_t at) {
      return load<std::int32_t>(record + at);
    };
    const std::int32_t x = wrapped_difference(coordinate(now, 0), coordinate(before, 0));
    const std::int32_t y = wrapped_difference(coordinate(now, 4), coordinate(before, 4));
    dx.encode_signed(encoder, median(dxs), x);
    dy.encode_signed(encoder, median(dys), y, std::min(dx.k(), 19u));
    const unsigned k = (dx.k() + dy.k()) / 2;
    z.encode_signed(encoder, coordinate(before, 8), coordinate(now, 8), std::min(k, 19u));
    dxs.erase(dxs.begin());
    dxs.push_back(x);
    dys.erase(dys.begin());
    dys.push_back(y);

    const auto short_at = [](const std::byte* record, std::size_t at) {
      return load<std::uint16_t>(record + at);
    };
    const unsigned symbol = (short_at(now, 12) != short_at(before, 12)) << 5 | (now[14] != before[14]) << 4 |
                            (now[15] != before[15]) << 3 | (now[16] != before[16]) << 2 |
                            (now[17] != before[17]) << 1 | (short_at(now, 18) != short_at(before, 18));
    encoder.symbol(changed, symbol);
    if (symbol & 32) intensity.encode(encoder, short_at(before, 12), short_at(now, 12));
    if (symbol & 16) encoder.symbol(returns[byte(before, 14)], byte(now, 14));
    if (symbol & 8) encoder.symbol(classification[byte(before, 15)], byte(now, 15));
    if (symbol & 4) scan_angle.encode(encoder, byte(before, 16), byte(now, 16), k < 3);
    if (symbol & 2) encoder.symbol(user_data[byte(before, 17)], byte(now, 17));
    if (symbol & 1) point_source.encode(encoder, short_at(before, 18), short_at(now, 18));
  }

  void encode_time(std::uint64_t before, std::uint64_t now) {
    const bool first = time_step == 0;
    const auto step = static_cast<std::int64_t>(now - before);
    const auto put = [&](unsigned of_first, unsigned of_next) {
      first ? encoder.symbol(time_first, of_first) : encoder.symbol(time_next, of_next);
    };
    if (step == 0) return put(0, 511);
    if (step != static_cast<std::int32_t>(step)) {
      put(2, 510);
      encoder.bits(static_cast<std::uint32_t>(now), 32);
      encoder.bits(static_cast<std::uint32_t>(now >> 32), 32);
    } else if (first) {
      encoder.symbol(time_first, 1);
      time.encode(encoder, 0, static_cast<std::uint32_t>(step), 0);
      time_step = static_cast<std::int32_t>(step);
    } else {
      const auto factor =
          static_cast<unsigned>(std::clamp(std::lround(double(step) / double(time_step)), 0l, 509l));
      encoder.symbol(time_next, factor);
      const std::int64_t prediction = factor == 0 ? time_step / 4 : std::int64_t{factor} * time_step;
      const unsigned context = factor == 0 ? 2 : factor == 1 ? 1 : factor < 10 ? 3 : factor < 50 ? 4 : 5;
      time.encode(encoder, static_cast<std::uint32_t>(prediction), static_cast<std::uint32_t>(step), context);
      if (factor == 1 || ((factor == 0 || factor == 509) && ++extremes > 3)) {
        time_step = static_cast<std::int32_t>(step);
        extremes = 0;
      }
    }
  }

  void encode(const std::byte* now) {
    std::size_t at = 0;
    for (const laz::Item& item : layout.items) {
      if (item.type == laz::item_type::kPoint10) encode_point(now);
      if (item.type == laz::item_type::kGpsTime11) {
        encode_time(load<std::uint64_t>(&last[at]), load<std::uint64_t>(now + at));
      }
      if (item.type == laz::item_type::kRgb12) {
        unsigned symbol = 0;
        for (unsigned i = 0; i < 6; ++i) symbol |= (last[at + i] != now[at + i]) << i;
        encoder.symbol(rgb_changed, symbol);
        for (unsigned i = 0; i < 6; ++i) {
          if (symbol >> i & 1) rgb.encode(encoder, number(last[at + i]), number(now[at + i]), i);
        }
      }
      if (item.type == laz::item_type::kByte) {
        for (unsigned i = 0; i < item.size; ++i)
          extra_bytes.encode(encoder, number(last[at + i]), number(now[at + i]), extra_ks[i]);
      }
      at += item.size;
    }
    last.assign(now, now + last.size());
  }

  static std::uint32_t number(std::byte byte) { return std::to_integer<std::uint32_t>(byte); }
};

}  // namespace

std::vector<std::byte> laz_chunk_of_version1(const laz::Layout& layout, std::span<const std::byte> records) {
  const std::size_t size = layout.record_bytes();
  const auto encoder = std::make_unique<Version1Encoder>(layout, records.data());
  for (std::size_t at = size; at < records.size(); at += size) encoder->encode(&records[at]);
  std::vector<std::byte> chunk(records.begin(), records.begin() + static_cast<std::ptrdiff_t>(size));
  const std::vector<std::byte> rest = encoder->encoder.finish();
  chunk.insert(chunk.end(), rest.begin(), rest.end());
  return chunk;
}

}  // namespace lacuna::test
