// SPDX-License-Identifier: Apache-2.0
#include "tests/support/laz_encoder.hpp"

#include "io/laz/contexts.hpp"
#include "io/laz/streaming_median.hpp"
#include "io/laz/symbol_model.hpp"
#include "io/little_endian.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace lacuna::test {
using namespace io;

namespace {

using laz::BitModel;
using laz::StreamingMedian;
using laz::SymbolModel;
using Model = SymbolModel<516>;  // the largest alphabet; here all models have its capacity

class Encoder {
 public:
  void symbol(Model& model, unsigned symbol) {
    const std::uint32_t unit = length_ >> Model::kShareBits;
    const std::uint32_t start = model.start(symbol) * unit;
    const std::uint32_t end = symbol + 1 == model.symbols() ? length_ : model.start(symbol + 1) * unit;
    narrow(start, end - start);
    model.count(symbol);
  }
  void bit(BitModel& model, bool bit) {
    const std::uint32_t zero = model.share_of_zero() * (length_ >> BitModel::kShareBits);
    bit ? narrow(zero, length_ - zero) : narrow(0, zero);
    model.count(bit);
  }
  void bits(std::uint32_t bits, unsigned count) {
    if (count > 19) {
      this->bits(bits & 0xffff, 16);
      bits >>= 16;
      count -= 16;
    }
    const std::uint32_t unit = length_ >> count;
    narrow(bits * unit, unit);
  }

  LazBytes done() {
    const bool long_end = length_ > 2u << 24;
    long_end ? narrow(1u << 24, 1u << 23) : narrow(1u << 23, 1u << 15);
    bytes_.insert(bytes_.end(), long_end ? 3 : 2, std::byte{0});
    return bytes_;
  }

  bool changed = false;  // of a layer: whether any value differs from the one before

 private:
  void narrow(std::uint32_t start, std::uint32_t length) {
    const std::uint32_t before = base_;
    base_ += start;
    length_ = length;
    if (base_ < before) {
      auto byte = bytes_.rbegin();
      while (*byte == std::byte{0xff}) *byte++ = std::byte{0};
      *byte = static_cast<std::byte>(std::to_integer<int>(*byte) + 1);
    }
    while (length_ < 1u << 24) {
      bytes_.push_back(static_cast<std::byte>(base_ >> 24));
      base_ <<= 8;
      length_ <<= 8;
    }
  }

  LazBytes bytes_;
  std::uint32_t base_ = 0, length_ = 0xffffffff;
};

// A model for each context, all of the same number of symbols.
class Models {
 public:
  explicit Models(unsigned symbols) : symbols_(symbols) {}
  Model& operator[](unsigned context) { return models_.try_emplace(context, symbols_).first->second; }

 private:
  unsigned symbols_;
  std::map<unsigned, Model> models_;
};

class IntegerEncoder {
 public:
  explicit IntegerEncoder(unsigned bits) : bits_(bits), ks_(bits + 1) {}

  void encode(Encoder& encoder, std::int64_t prediction, std::int64_t value, unsigned context = 0) {
    const std::int64_t range = std::int64_t{1} << bits_;
    std::int64_t c = (value - prediction) % range;
    if (c < -range / 2) c += range;
    if (c >= range / 2) c -= range;
    k = 0;
    for (std::int64_t rest = c <= 0 ? -c : c - 1; rest; rest /= 2) ++k;
    encoder.symbol(ks_[context], k);
    if (k == 0) return encoder.bit(bit_, c == 1);
    if (k == 32) return;
    const auto place = static_cast<std::uint32_t>(c < 0 ? c + (std::int64_t{1} << k) - 1 : c - 1);
    const unsigned low = k > 8 ? k - 8 : 0;
    encoder.symbol(places_.try_emplace(k, 1u << std::min(k, 8u)).first->second, place >> low);
    if (low) encoder.bits(place & ((1u << low) - 1), low);
  }

  unsigned k = 0;

 private:
  unsigned bits_;
  Models ks_;
  BitModel bit_;
  std::map<unsigned, Model> places_;
};

struct RgbEncoder {
  Model changed{128};
  Models bytes{256};

  void encode(Encoder& encoder, const std::uint16_t* last, const std::uint16_t* now) {
    unsigned symbol = now[0] != now[1] || now[0] != now[2] ? 64 : 0;
    for (unsigned i = 0; i < 6; ++i) {
      const unsigned shift = i % 2 * 8;
      if ((last[i / 2] >> shift & 255) != (now[i / 2] >> shift & 255)) symbol |= 1u << i;
    }
    encoder.symbol(changed, symbol);
    const auto byte = [](std::uint16_t value, unsigned shift) { return value >> shift & 255; };
    for (unsigned i = 0; i < 2; ++i) {
      if (symbol >> i & 1) encoder.symbol(bytes[i], (byte(now[0], i * 8) - byte(last[0], i * 8)) & 255);
    }
    if (!(symbol & 64)) return;
    for (unsigned shift = 0; shift < 16; shift += 8) {
      const unsigned green = 2 + shift / 8, blue = 4 + shift / 8;
      int change = byte(now[0], shift) - byte(last[0], shift);
      const auto encode_byte = [&](unsigned index, std::uint16_t before, std::uint16_t after) {
        if (!(symbol >> index & 1)) return;
        const int predicted = std::clamp(byte(before, shift) + change, 0, 255);
        encoder.symbol(bytes[index], (byte(after, shift) - predicted) & 255);
      };
      encode_byte(green, last[1], now[1]);
      change = (change + byte(now[1], shift) - byte(last[1], shift)) / 2;
      encode_byte(blue, last[2], now[2]);
    }
  }
};

struct NirEncoder {
  Model changed{4};
  Models bytes{256};

  void encode(Encoder& encoder, std::uint16_t last, std::uint16_t now) {
    const unsigned low = (now - last) & 255, high = ((now >> 8) - (last >> 8)) & 255;
    encoder.symbol(changed, (low ? 1 : 0) + (high ? 2 : 0));
    if (low) encoder.symbol(bytes[0], low);
    if (high) encoder.symbol(bytes[1], high);
  }
};

// GPSTIME11 version 2 where `has_unchanged`, else the layer of POINT14.
class GpsTimeEncoder {
 public:
  GpsTimeEncoder(std::uint64_t first, bool has_unchanged)
      : has_unchanged_(has_unchanged), first_(has_unchanged ? 6 : 5), next_(has_unchanged ? 516 : 515) {
    times_[0] = first;
  }

  void encode(Encoder& encoder, std::uint64_t time) {
    const bool first = differences_[at_] == 0;
    if (has_unchanged_ && time == times_[at_]) return encoder.symbol(first ? first_ : next_, first ? 0 : 511);
    if (const auto difference = difference_to(at_, time)) {
      first ? encode_first(encoder, *difference) : encode_next(encoder, *difference);
      times_[at_] = time;
      return;
    }
    const unsigned full = (first ? 1 : 511) + (has_unchanged_ ? 1 : 0);
    for (unsigned step = 1; step < 4; ++step) {
      if (!difference_to((at_ + step) % 4, time)) continue;
      encoder.symbol(first ? first_ : next_, full + step);
      at_ = (at_ + step) % 4;
      return encode(encoder, time);
    }
    encoder.symbol(first ? first_ : next_, full);
    integers_.encode(encoder, static_cast<std::int32_t>(times_[at_] >> 32),
                     static_cast<std::int32_t>(time >> 32), 8);
    encoder.bits(static_cast<std::uint32_t>(time), 32);
    at_ = newest_ = (newest_ + 1) % 4;
    times_[at_] = time;
    differences_[at_] = 0;
    extremes_[at_] = 0;
  }

 private:
  std::optional<std::int32_t> difference_to(unsigned sequence, std::uint64_t time) const {
    const auto difference = static_cast<std::int64_t>(time - times_[sequence]);
    if (difference != static_cast<std::int32_t>(difference)) return std::nullopt;
    return static_cast<std::int32_t>(difference);
  }

  void encode_first(Encoder& encoder, std::int32_t difference) {
    encoder.symbol(first_, has_unchanged_ ? 1 : 0);
    integers_.encode(encoder, 0, difference, 0);
    differences_[at_] = difference;
    extremes_[at_] = 0;
  }

  void encode_next(Encoder& encoder, std::int32_t difference) {
    const std::int64_t last = differences_[at_];
    const long factor = std::clamp(std::lround(double(difference) / double(last)), -10l, 500l);
    const unsigned symbol = static_cast<unsigned>(factor >= 0 ? factor : 500 - factor);
    const unsigned context = factor == 0     ? 7
                             : factor == 1   ? 1
                             : factor == 500 ? 4
                             : factor >= 10  ? 3
                             : factor > 0    ? 2
                             : factor > -10  ? 5
                                             : 6;
    encoder.symbol(next_, symbol);
    integers_.encode(encoder, static_cast<std::int32_t>(static_cast<std::uint32_t>(factor * last)),
                     difference, context);
    if (factor == 1) extremes_[at_] = 0;
    if ((factor == 0 || factor == 500 || factor == -10) && ++extremes_[at_] > 3) {
      differences_[at_] = difference;
      extremes_[at_] = 0;
    }
  }

  bool has_unchanged_;
  std::uint64_t times_[4] = {};
  std::int32_t differences_[4] = {};
  int extremes_[4] = {};
  unsigned at_ = 0, newest_ = 0;
  Model first_, next_;
  IntegerEncoder integers_{32};
};

std::int32_t difference_of(std::int32_t now, std::int32_t last) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(now) - static_cast<std::uint32_t>(last));
}

struct Point10Encoder {
  LazBytes last;
  std::uint16_t intensities[16] = {};
  std::int32_t heights[8] = {};
  StreamingMedian x_medians[16], y_medians[16];
  Model changed{64};
  Models returns{256}, classification{256}, scan_angle{256}, user_data{256};
  IntegerEncoder intensity{16}, point_source{16}, dx{32}, dy{32}, z{32};

  explicit Point10Encoder(const std::byte* first) : last(first, first + 20) {}

  // By number of returns and return number, in hexadecimal.
  static unsigned context(unsigned n, unsigned r) {
    static const std::string rows[8] = {"fedcba98", "e0136aa9", "d1247bba", "c3458ccb",
                                        "b6789ddc", "aabcdeed", "9abcdefe", "89abcdef"};
    const char digit = rows[n][r];
    return static_cast<unsigned>(digit <= '9' ? digit - '0' : digit - 'a' + 10);
  }

  void encode(Encoder& encoder, const std::byte* now) {
    const auto byte = [](const std::byte* record, std::size_t at) { return load<std::uint8_t>(record + at); };
    const std::byte* before = last.data();
    const unsigned r = byte(now, 14) & 7, n = byte(now, 14) >> 3 & 7, m = context(n, r);
    const auto now_intensity = load<std::uint16_t>(now + 12);
    const auto source = load<std::uint16_t>(now + 18), last_source = load<std::uint16_t>(before + 18);
    const unsigned symbol =
        (byte(now, 14) != byte(before, 14)) << 5 | (now_intensity != intensities[m]) << 4 |
        (byte(now, 15) != byte(before, 15)) << 3 | (byte(now, 16) != byte(before, 16)) << 2 |
        (byte(now, 17) != byte(before, 17)) << 1 | (source != last_source);
    encoder.symbol(changed, symbol);
    if (symbol & 32) encoder.symbol(returns[byte(before, 14)], byte(now, 14));
    if (symbol & 16) {
      intensity.encode(encoder, intensities[m], now_intensity, std::min(m, 3u));
      intensities[m] = now_intensity;
    }
    if (symbol & 8) encoder.symbol(classification[byte(before, 15)], byte(now, 15));
    if (symbol & 4)
      encoder.symbol(scan_angle[byte(now, 14) >> 6 & 1], (byte(now, 16) - byte(before, 16)) & 255);
    if (symbol & 2) encoder.symbol(user_data[byte(before, 17)], byte(now, 17));
    if (symbol & 1) point_source.encode(encoder, last_source, source);

    const unsigned only = n == 1 ? 1 : 0;
    const std::int32_t x = difference_of(load<std::int32_t>(now), load<std::int32_t>(before));
    dx.encode(encoder, x_medians[m].middle(), x, only);
    x_medians[m].add(x);
    const std::int32_t y = difference_of(load<std::int32_t>(now + 4), load<std::int32_t>(before + 4));
    dy.encode(encoder, y_medians[m].middle(), y, only + (dx.k < 20 ? dx.k / 2 * 2 : 20));
    y_medians[m].add(y);
    const unsigned k = (dx.k + dy.k) / 2;
    std::int32_t& height = heights[n > r ? n - r : r - n];
    z.encode(encoder, height, load<std::int32_t>(now + 8), only + (k < 18 ? k / 2 * 2 : 18));
    height = load<std::int32_t>(now + 8);
    last.assign(now, now + 20);
  }
};

struct PointwiseEncoder {
  const laz::Layout& layout;
  Encoder encoder;
  LazBytes last;
  std::unique_ptr<Point10Encoder> point;
  std::unique_ptr<GpsTimeEncoder> gps_time;
  RgbEncoder rgb;
  Models extra_bytes{256};

  PointwiseEncoder(const laz::Layout& of, const std::byte* first)
      : layout(of), last(first, first + of.record_bytes()), point(std::make_unique<Point10Encoder>(first)) {
    if (of.items.size() > 1 && of.items[1].type == laz::item_type::kGpsTime11) {
      gps_time = std::make_unique<GpsTimeEncoder>(load<std::uint64_t>(first + 20), true);
    }
  }

  void encode(const std::byte* now) {
    std::size_t at = 0;
    for (const laz::Item& item : layout.items) {
      if (item.type == laz::item_type::kPoint10) point->encode(encoder, now);
      if (item.type == laz::item_type::kGpsTime11) gps_time->encode(encoder, load<std::uint64_t>(now + at));
      if (item.type == laz::item_type::kRgb12) {
        std::uint16_t before[3], after[3];
        std::memcpy(before, &last[at], 6);
        std::memcpy(after, now + at, 6);
        rgb.encode(encoder, before, after);
      }
      if (item.type == laz::item_type::kByte) {
        for (unsigned i = 0; i < item.size; ++i) {
          const int difference = std::to_integer<int>(now[at + i]) - std::to_integer<int>(last[at + i]);
          encoder.symbol(extra_bytes[i], static_cast<unsigned>(difference & 255));
        }
      }
      at += item.size;
    }
    last.assign(now, now + last.size());
  }
};

// Version 1 of POINT10, GPSTIME11, RGB12 and BYTE.
struct Version1Encoder {
  const laz::Layout& layout;
  Encoder encoder;
  LazBytes last;
  std::vector<std::int32_t> dxs{0, 0, 0}, dys{0, 0, 0};  // the last three
  IntegerEncoder dx{32}, dy{32}, z{32}, intensity{16}, scan_angle{8}, point_source{16};
  Model changed{64};
  Models returns{256}, classification{256}, user_data{256};
  std::int32_t time_step = 0;
  int extremes = 0;
  Model time_first{3}, time_next{512};
  IntegerEncoder time{32}, rgb{8}, extra_bytes{8};
  Model rgb_changed{64};

  Version1Encoder(const laz::Layout& of, const std::byte* first)
      : layout(of), last(first, first + of.record_bytes()) {}

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
    const std::int32_t x = difference_of(coordinate(now, 0), coordinate(before, 0));
    const std::int32_t y = difference_of(coordinate(now, 4), coordinate(before, 4));
    dx.encode(encoder, median(dxs), x);
    dy.encode(encoder, median(dys), y, std::min(dx.k, 19u));
    const unsigned k = (dx.k + dy.k) / 2;
    z.encode(encoder, coordinate(before, 8), coordinate(now, 8), std::min(k, 19u));
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
    if (step == 0) return encoder.symbol(first ? time_first : time_next, first ? 0 : 511);
    if (step != static_cast<std::int32_t>(step)) {
      encoder.symbol(first ? time_first : time_next, first ? 2 : 510);
      encoder.bits(static_cast<std::uint32_t>(now), 32);
      encoder.bits(static_cast<std::uint32_t>(now >> 32), 32);
    } else if (first) {
      encoder.symbol(time_first, 1);
      time.encode(encoder, 0, step, 0);
      time_step = static_cast<std::int32_t>(step);
    } else {
      const auto factor =
          static_cast<unsigned>(std::clamp(std::lround(double(step) / double(time_step)), 0l, 509l));
      encoder.symbol(time_next, factor);
      const std::int64_t prediction = factor == 0 ? time_step / 4 : std::int64_t{factor} * time_step;
      const unsigned context = factor == 0 ? 2 : factor == 1 ? 1 : factor < 10 ? 3 : factor < 50 ? 4 : 5;
      time.encode(encoder, static_cast<std::int32_t>(static_cast<std::uint32_t>(prediction)), step, context);
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
          if (symbol >> i & 1) encode_byte(rgb, last[at + i], now[at + i], i);
        }
      }
      if (item.type == laz::item_type::kByte) {
        for (unsigned i = 0; i < item.size; ++i) encode_byte(extra_bytes, last[at + i], now[at + i], i);
      }
      at += item.size;
    }
    last.assign(now, now + last.size());
  }

  void encode_byte(IntegerEncoder& integers, std::byte before, std::byte now, unsigned context) {
    integers.encode(encoder, std::to_integer<int>(before), std::to_integer<int>(now), context);
  }
};

// A point of 30 bytes, taken apart.
struct Point14 {
  std::int32_t x, y, z;
  std::uint16_t intensity, scan_angle, point_source;
  unsigned r, n, channel, flags, classification, user_data;
  std::uint64_t gps_time;

  explicit Point14(const std::byte* at)
      : x(load<std::int32_t>(at)),
        y(load<std::int32_t>(at + 4)),
        z(load<std::int32_t>(at + 8)),
        intensity(load<std::uint16_t>(at + 12)),
        scan_angle(load<std::uint16_t>(at + 18)),
        point_source(load<std::uint16_t>(at + 20)),
        r(load<std::uint8_t>(at + 14) & 15),
        n(load<std::uint8_t>(at + 14) >> 4),
        channel(load<std::uint8_t>(at + 15) >> 4 & 3),
        flags((load<std::uint8_t>(at + 15) & 15) | load<std::uint8_t>(at + 15) >> 6 << 4),
        classification(load<std::uint8_t>(at + 16)),
        user_data(load<std::uint8_t>(at + 17)),
        gps_time(load<std::uint64_t>(at + 22)) {}
};

struct Point14Encoder {
  struct Channel {
    Point14 last;
    bool new_time = false;
    Models changed{128}, step{3}, number{16}, number_of{16}, number_step{13};
    IntegerEncoder dx{32}, dy{32}, z{32}, intensity{16}, scan_angle{16}, point_source{16};
    std::map<unsigned, StreamingMedian> x_medians, y_medians;
    std::map<unsigned, std::int32_t> heights;
    std::map<unsigned, std::uint16_t> intensities;
    Models classification{256}, flags{64}, user_data{256};
    GpsTimeEncoder gps_time;
    explicit Channel(const Point14& first) : last(first), gps_time(first.gps_time, false) {
      for (unsigned i = 0; i < 8; ++i) heights[i] = first.z, intensities[i] = first.intensity;
    }
  };
  enum {
    kXy,
    kZ,
    kClassification,
    kFlags,
    kIntensity,
    kScanAngle,
    kUserData,
    kPointSource,
    kGpsTime,
    kLayers
  };

  Encoder layers[kLayers];
  std::unique_ptr<Channel> channels[4];
  unsigned at;

  explicit Point14Encoder(const Point14& first) : at(first.channel) {
    channels[at] = std::make_unique<Channel>(first);
    layers[kXy].changed = true;
  }

  // By number of returns and return number.
  static unsigned context(unsigned n, unsigned r) {
    static const std::string rows[16] = {
        "0123453445555555", "1013333333333333", "2124444444433333", "3345444444444444",
        "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
        "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
        "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455"};
    return static_cast<unsigned>(rows[n][r] - '0');
  }

  void encode(const Point14& now) {
    Channel& before = *channels[at];
    const bool exists = channels[now.channel] != nullptr;
    const Point14 old = exists ? channels[now.channel]->last : before.last;
    const bool time = now.gps_time != old.gps_time;
    const unsigned step = (now.r - old.r) & 15;
    const unsigned number = step == 0 ? 0 : step == 1 ? 1 : step == 15 ? 2 : 3;
    const unsigned changed = number | (now.n != old.n) << 2 | (now.scan_angle != old.scan_angle) << 3 |
                             time << 4 | (now.point_source != old.point_source) << 5 |
                             (now.channel != at) << 6;
    Encoder& xy = layers[kXy];
    xy.symbol(before.changed[(before.last.r == 1 ? 1 : 0) + (before.last.r >= before.last.n ? 2 : 0) +
                             (before.new_time ? 4 : 0)],
              changed);
    if (now.channel != at) {
      xy.symbol(before.step[0], (now.channel - at - 1) & 3);
      if (!exists) channels[now.channel] = std::make_unique<Channel>(before.last);
      at = now.channel;
    }
    Channel& c = *channels[at];
    if (now.n != old.n) xy.symbol(c.number_of[old.n], now.n);
    if (number == 3) time ? xy.symbol(c.number[old.r], now.r) : xy.symbol(c.number_step[0], step - 2);

    const unsigned only = now.n == 1 ? 1 : 0, m = context(now.n, now.r) * 2 + time;
    const std::int32_t x = difference_of(now.x, old.x), y = difference_of(now.y, old.y);
    c.dx.encode(xy, c.x_medians[m].middle(), x, only);
    c.x_medians[m].add(x);
    c.dy.encode(xy, c.y_medians[m].middle(), y, only + (c.dx.k < 20 ? c.dx.k / 2 * 2 : 20));
    c.y_medians[m].add(y);

    const auto note = [&](int layer, bool differs) {
      layers[layer].changed = layers[layer].changed || differs;
    };
    const unsigned k = (c.dx.k + c.dy.k) / 2,
                   level = std::min(now.n > now.r ? now.n - now.r : now.r - now.n, 7u);
    note(kZ, now.z != old.z);
    c.z.encode(layers[kZ], c.heights[level], now.z, only + (k < 18 ? k / 2 * 2 : 18));
    c.heights[level] = now.z;

    const unsigned place = (now.r == 1 ? 1 : 0) + (now.r >= now.n ? 2 : 0);
    note(kClassification, now.classification != old.classification);
    layers[kClassification].symbol(c.classification[(old.classification & 31) * 2 + (place == 3 ? 1 : 0)],
                                   now.classification);
    note(kFlags, now.flags != old.flags);
    layers[kFlags].symbol(c.flags[old.flags], now.flags);
    note(kIntensity, now.intensity != old.intensity);
    c.intensity.encode(layers[kIntensity], c.intensities[place * 2 + time], now.intensity, place);
    c.intensities[place * 2 + time] = now.intensity;
    if (now.scan_angle != old.scan_angle) {
      note(kScanAngle, true);
      c.scan_angle.encode(layers[kScanAngle], old.scan_angle, now.scan_angle, time);
    }
    note(kUserData, now.user_data != old.user_data);
    layers[kUserData].symbol(c.user_data[old.user_data / 4], now.user_data);
    if (now.point_source != old.point_source) {
      note(kPointSource, true);
      c.point_source.encode(layers[kPointSource], old.point_source, now.point_source);
    }
    if (time) {
      note(kGpsTime, true);
      c.gps_time.encode(layers[kGpsTime], now.gps_time);
    }
    c.last = now;
    c.new_time = time;
  }
};

// RGB14, RGBNIR14 and BYTE14: of each scanner channel, by the rules of their version.
struct ColourEncoder {
  struct Channel {
    LazBytes last;
    RgbEncoder rgb;
    NirEncoder nir;
    Models bytes{256};
  };
  laz::Item item;
  std::map<unsigned, Channel> channels;
  unsigned at;
  std::deque<Encoder> layers;

  ColourEncoder(const laz::Item& of, const std::byte* first, unsigned channel) : item(of), at(channel) {
    channels[channel].last.assign(first, first + item.size);
    layers.resize(item.type == laz::item_type::kByte14  ? item.size
                  : item.type == laz::item_type::kRgb14 ? 1
                                                        : 2);
  }

  void encode(const std::byte* now, unsigned channel, bool switched) {
    // LASzip's version 3 takes any point for one of channel 0 but at a switch. At a switch to a channel that
    // it knows, it goes on with the values of the one before.
    const unsigned next = item.version == 4 || switched ? channel : 0;
    const bool fresh = channels.count(next) == 0;
    if (fresh) channels[next].last = channels[at].last;
    LazBytes& last = item.version == 4 || fresh ? channels[next].last : channels[at].last;
    at = next;
    Channel& models = channels[next];
    if (item.type == laz::item_type::kByte14) {
      for (unsigned i = 0; i < item.size; ++i) {
        const int difference = std::to_integer<int>(now[i]) - std::to_integer<int>(last[i]);
        layers[i].symbol(models.bytes[i], static_cast<unsigned>(difference & 255));
        layers[i].changed = layers[i].changed || difference != 0;
      }
    } else {
      std::uint16_t before[4] = {}, after[4] = {};
      std::memcpy(before, last.data(), item.size);
      std::memcpy(after, now, item.size);
      models.rgb.encode(layers[0], before, after);
      layers[0].changed = layers[0].changed || std::memcmp(before, after, 6) != 0;
      if (layers.size() == 2) {
        models.nir.encode(layers[1], before[3], after[3]);
        layers[1].changed = layers[1].changed || before[3] != after[3];
      }
    }
    last.assign(now, now + item.size);
  }
};

template <class T>
void append(LazBytes& bytes, T value) {
  bytes.resize(bytes.size() + sizeof value);
  std::memcpy(bytes.data() + bytes.size() - sizeof value, &value, sizeof value);
}

LazBytes layered_chunk(const laz::Layout& layout, std::span<const std::byte> records) {
  const std::size_t size = layout.record_bytes();
  const Point14 first(records.data());
  const auto point = std::make_unique<Point14Encoder>(first);
  std::deque<ColourEncoder> others;
  std::size_t at = 30;
  for (std::size_t i = 1; i < layout.items.size(); at += layout.items[i++].size) {
    others.emplace_back(layout.items[i], &records[at], first.channel);
  }
  for (std::size_t record = size; record < records.size(); record += size) {
    const Point14 now(&records[record]);
    const bool switched = now.channel != point->at;
    point->encode(now);
    at = record + 30;
    for (ColourEncoder& other : others) {
      other.encode(&records[at], now.channel, switched);
      at += other.item.size;
    }
  }

  LazBytes chunk(records.begin(), records.begin() + static_cast<std::ptrdiff_t>(size));
  append(chunk, static_cast<std::uint32_t>(records.size() / size));
  std::vector<Encoder*> layers;
  for (Encoder& layer : point->layers) layers.push_back(&layer);
  for (ColourEncoder& other : others) {
    for (Encoder& layer : other.layers) layers.push_back(&layer);
  }
  LazBytes data;
  for (Encoder* layer : layers) {
    const LazBytes bytes = layer->changed ? layer->done() : LazBytes();
    append(chunk, static_cast<std::uint32_t>(bytes.size()));
    data.insert(data.end(), bytes.begin(), bytes.end());
  }
  chunk.insert(chunk.end(), data.begin(), data.end());
  return chunk;
}

}  // namespace

laz::Layout laz_layout(int point_format, std::uint16_t extra_bytes, std::uint32_t chunk_points,
                       std::uint16_t version) {
  using namespace laz::item_type;
  laz::Layout layout{laz::compressor::kPointwiseChunked, chunk_points, {}};
  const bool layered = point_format >= 6;
  if (layered) {
    layout.compressor = laz::compressor::kLayeredChunked;
    layout.items.push_back({kPoint14, 30, version});
    if (point_format == 7) layout.items.push_back({kRgb14, 6, version});
    if (point_format == 8) layout.items.push_back({kRgbNir14, 8, version});
  } else {
    layout.items.push_back({kPoint10, 20, version});
    if (point_format & 1) layout.items.push_back({kGpsTime11, 8, version});
    if (point_format & 2) layout.items.push_back({kRgb12, 6, version});
  }
  if (extra_bytes) layout.items.push_back({layered ? kByte14 : kByte, extra_bytes, version});
  return layout;
}

LazBytes laz_record(const laz::Layout& layout) {
  LazBytes record;
  append(record, layout.compressor);
  append(record, std::uint16_t{0});  // arithmetic coder
  append(record, std::uint32_t{0});  // version of LASzip
  append(record, std::uint32_t{0});  // options
  append(record, layout.chunk_points);
  append(record, std::int64_t{-1});  // number and offset of special records
  append(record, std::int64_t{-1});
  append(record, static_cast<std::uint16_t>(layout.items.size()));
  for (const laz::Item& item : layout.items) {
    append(record, item.type);
    append(record, item.size);
    append(record, item.version);
  }
  return record;
}

LazBytes laz_chunk(const laz::Layout& layout, std::span<const std::byte> records) {
  if (layout.compressor == laz::compressor::kLayeredChunked) return layered_chunk(layout, records);
  const std::size_t size = layout.record_bytes();
  const auto compressed = [&](auto points) {
    for (std::size_t at = size; at < records.size(); at += size) points.encode(&records[at]);
    return points.encoder.done();
  };
  LazBytes chunk(records.begin(), records.begin() + static_cast<std::ptrdiff_t>(size));
  const LazBytes rest = layout.items[0].version == 1 ? compressed(Version1Encoder(layout, records.data()))
                                                     : compressed(PointwiseEncoder(layout, records.data()));
  chunk.insert(chunk.end(), rest.begin(), rest.end());
  return chunk;
}

LazBytes laz_chunk_table(const laz::Layout& layout, std::span<const laz::Chunk> chunks) {
  LazBytes table;
  append(table, std::uint32_t{0});
  append(table, static_cast<std::uint32_t>(chunks.size()));
  Encoder encoder;
  IntegerEncoder numbers(32);
  laz::Chunk before{};
  for (const laz::Chunk& chunk : chunks) {
    const auto number = [&](std::uint64_t last, std::uint64_t now, unsigned context) {
      numbers.encode(encoder, static_cast<std::int32_t>(last), static_cast<std::int32_t>(now), context);
    };
    if (layout.chunk_points == laz::kVariableChunks) number(before.points, chunk.points, 0);
    number(before.bytes, chunk.bytes, 1);
    before = chunk;
  }
  if (chunks.empty()) return table;
  const LazBytes rest = encoder.done();
  table.insert(table.end(), rest.begin(), rest.end());
  return table;
}

LazBytes laz_point_data(const laz::Layout& layout, std::span<const std::byte> records,
                        std::span<const std::uint64_t> chunk_points, std::uint64_t offset) {
  LazBytes data(8);
  std::vector<laz::Chunk> chunks;
  for (const std::uint64_t points : chunk_points) {
    const LazBytes chunk = laz_chunk(layout, records.first(points * layout.record_bytes()));
    records = records.subspan(points * layout.record_bytes());
    chunks.push_back({offset + data.size(), chunk.size(), points});
    data.insert(data.end(), chunk.begin(), chunk.end());
  }
  store(data.data(), offset + data.size());
  const LazBytes table = laz_chunk_table(layout, chunks);
  data.insert(data.end(), table.begin(), table.end());
  return data;
}

}  // namespace lacuna::test
