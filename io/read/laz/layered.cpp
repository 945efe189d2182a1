// SPDX-License-Identifier: Apache-2.0
// Chunks of point formats 6 to 8: each attribute in a stream of its own (LAZ, compressor 3).
#include "io/read/files/number.hpp"
#include "io/read/laz/items.hpp"
#include "io/read/laz/point14.hpp"
#include "io/read/laz/predicted_values.hpp"

#include <array>
#include <cstring>
#include <optional>

namespace lacuna::io::laz {

template <class Layer>
Point14<Layer>::Point14(const std::byte* first, std::span<Layer, kLayers> layers)
    : layers_(layers), channel_(point14::channel_of(first)) {
  channels_[channel_] = std::make_unique<point14::Channel>(point14::read_fields(first));
  if constexpr (Layer::kEncodes) {
    layers_[kReturnsXy].has_changes = true;  // a chunk always has it
  } else if (!layers_[kReturnsXy].decoder) {
    throw Corrupt("a chunk of compressed points has no layer of coordinates");
  }
}

template <class Layer>
void Point14<Layer>::code(ItemByte<Layer>* item) {
  point14::Fields now{};
  unsigned channel_of_item = 0;
  if constexpr (Layer::kEncodes) {
    now = point14::read_fields(item);
    channel_of_item = point14::channel_of(item);
  }
  const unsigned changed = code_changes(now, channel_of_item);
  point14::Channel& channel = *channels_[channel_];
  if constexpr (!Layer::kEncodes) now = channel.last;
  code_returns(channel, now, changed);
  code_position(channel, now, changed & point14::kGpsTime);
  code_attributes(channel, now, changed);
  channel.last_has_new_time = changed & point14::kGpsTime;
  channel.last = now;
  if constexpr (!Layer::kEncodes) point14::write_fields(now, channel_, item);
}

template <class Layer>
unsigned Point14<Layer>::changes_to(const point14::Fields& now, unsigned channel) const {
  const point14::Fields& last = channels_[channels_[channel] ? channel : channel_]->last;
  const unsigned step = (now.return_number + 16u - last.return_number) % 16;
  const unsigned of_return = step < 2 ? step : step == 15 ? 2u : point14::kReturnNumber;
  return of_return | (now.number_of_returns != last.number_of_returns ? point14::kNumberOfReturns : 0) |
         (now.scan_angle != last.scan_angle ? point14::kScanAngle : 0) |
         (now.gps_time != last.gps_time ? point14::kGpsTime : 0) |
         (now.point_source != last.point_source ? point14::kPointSource : 0) |
         (channel != channel_ ? point14::kScannerChannel : 0);
}

// Codes what changed, by the models of the last point's channel; goes over to this point's channel. An
// encoder knows the point and its channel.
template <class Layer>
unsigned Point14<Layer>::code_changes(const point14::Fields& now, unsigned channel) {
  point14::Channel& before = *channels_[channel_];
  unsigned changed = Layer::kEncodes ? changes_to(now, channel) : 0;
  layers_[kReturnsXy].code([&](auto& coder) {
    coder.code(before.changed[before.change_context()], changed);
    changed_channel_ = changed & point14::kScannerChannel;
    if (!changed_channel_) return;
    unsigned step = (channel + point14::kChannels - channel_ - 1) % point14::kChannels;
    coder.code(before.channel_step, step);
    channel_ = (channel_ + step + 1) % point14::kChannels;
  });
  if (!channels_[channel_]) channels_[channel_] = std::make_unique<point14::Channel>(before.last);
  return changed;
}

template <class Layer>
void Point14<Layer>::code_returns(point14::Channel& channel, point14::Fields& now, unsigned changed) {
  const point14::Fields& last = channel.last;
  layers_[kReturnsXy].code([&](auto& coder) {
    if (changed & point14::kNumberOfReturns)
      coder.code(channel.number_of_returns[last.number_of_returns], now.number_of_returns);
    const unsigned of_return = changed & point14::kReturnNumber;
    if (of_return == point14::kReturnNumber && changed & point14::kGpsTime)
      return coder.code(channel.return_number[last.return_number], now.return_number);
    unsigned step = of_return < 2 ? of_return : 15;
    if (of_return == point14::kReturnNumber) {
      step = (now.return_number + 16u - last.return_number) % 16 - 2;
      coder.code(channel.return_number_step, step);
      step += 2;
    }
    now.return_number = static_cast<std::uint8_t>((last.return_number + step) % 16);
  });
}

template <class Layer>
void Point14<Layer>::code_position(point14::Channel& channel, point14::Fields& now, bool new_time) {
  const point14::Fields& last = channel.last;
  const bool only = now.number_of_returns == 1;
  const unsigned context = point14::return_context(now, new_time);
  layers_[kReturnsXy].code([&](auto& coder) {
    StreamingMedian &x_median = channel.x_medians[context], &y_median = channel.y_medians[context];
    std::int32_t dx = wrapped_difference(now.x, last.x), dy = wrapped_difference(now.y, last.y);
    channel.dx.code(coder, x_median.middle(), dx, only);
    x_median.add(dx);
    now.x = wrapped_sum(last.x, dx);
    channel.dy.code(coder, y_median.middle(), dy, k_context(channel.dx.k(), kLargestYContext, only));
    y_median.add(dy);
    now.y = wrapped_sum(last.y, dy);
  });
  layers_[kZ].code(last.z, now.z, [&](auto& coder) {
    const unsigned k = (channel.dx.k() + channel.dy.k()) / 2;
    std::int32_t& z = channel.last_z[point14::height_level(now)];
    channel.z.code(coder, z, now.z, k_context(k, kLargestZContext, only));
    z = now.z;
  });
}

template <class Layer>
void Point14<Layer>::code_attributes(point14::Channel& channel, point14::Fields& now, unsigned changed) {
  const point14::Fields& last = channel.last;
  const bool new_time = changed & point14::kGpsTime;
  const unsigned place = point14::place_in_pulse(now);
  layers_[kClassification].code(last.classification, now.classification, [&](auto& coder) {
    coder.code(channel.classification[point14::classification_context(last, place)], now.classification);
  });
  layers_[kFlags].code(last.flags, now.flags,
                       [&](auto& coder) { coder.code(channel.flags[last.flags], now.flags); });
  layers_[kIntensity].code(last.intensity, now.intensity, [&](auto& coder) {
    std::uint16_t& intensity = channel.last_intensities[place * 2 + (new_time ? 1 : 0)];
    channel.intensity.code(coder, intensity, now.intensity, place);
    intensity = now.intensity;
  });
  if (changed & point14::kScanAngle) {
    layers_[kScanAngle].code(last.scan_angle, now.scan_angle, [&](auto& coder) {
      channel.scan_angle.code(coder, last.scan_angle, now.scan_angle, new_time);
    });
  }
  layers_[kUserData].code(last.user_data, now.user_data, [&](auto& coder) {
    coder.code(channel.user_data[last.user_data / 4u], now.user_data);
  });
  if (changed & point14::kPointSource) {
    layers_[kPointSource].code(last.point_source, now.point_source, [&](auto& coder) {
      channel.point_source.code(coder, last.point_source, now.point_source);
    });
  }
  if (new_time) {
    layers_[kGpsTime].code(last.gps_time, now.gps_time,
                           [&](auto& coder) { channel.gps_times.code(coder, now.gps_time); });
  }
}

namespace {

// The last values and the models of colours and extra bytes, for each scanner channel.

// In version 3 of the items, LASzip chose wrongly between channels, and the format has kept this. Only where
// the channel changes, an item is coded by the point's channel; elsewhere it is coded by channel 0. At a
// change to a channel that has been used, the last values are still the ones of the channel before. They
// become this point's. Version 4 uses the point's channel.
enum class ChannelRule { kVersion3, kVersion4 };

template <class Values, class Models>
class ChannelValues {
 public:
  // `channel` is the first point's, `first` are its values. Models are copies of `models`.
  ChannelValues(ChannelRule rule, unsigned channel, const Values& first, const Models& models)
      : rule_(rule), channel_(channel), new_models_(models) {
    channels_[channel].emplace(first, models);
  }

  struct Chosen {
    Values& last;  // to read, and to be set to the point's
    Models& models;
  };
  // Returns the values and models for a point of `channel`. `changed` says that the point before it was of
  // another channel.
  Chosen choose(unsigned channel, bool changed) {
    const unsigned next = rule_ == ChannelRule::kVersion4 || changed ? channel : 0;
    Channel* of_values = &*channels_[channel_];
    if (next != channel_) {
      const bool is_new = !channels_[next];
      if (is_new) channels_[next].emplace(of_values->last, new_models_);
      if (is_new || rule_ == ChannelRule::kVersion4) of_values = &*channels_[next];
      channel_ = next;
    }
    return {of_values->last, channels_[next]->models};
  }

 private:
  struct Channel {
    Channel(const Values& first, const Models& fresh) : last(first), models(fresh) {}
    Values last;
    Models models;
  };

  ChannelRule rule_;
  unsigned channel_;
  Models new_models_;
  std::array<std::optional<Channel>, 4> channels_;
};

constexpr std::size_t kNumberBytes = 4;  // of a number before the layers

// RGB14 has no `nir`: it is 0.
struct ColourValue {
  Rgb rgb;
  std::uint16_t nir;
};

struct ColourModels {
  RgbModels rgb;
  NirModels nir;
};

ColourValue read_colour(bool has_nir, const std::byte* item) {
  ColourValue colour{};
  std::memcpy(&colour, item, has_nir ? sizeof(ColourValue) : sizeof(Rgb));
  return colour;
}

// RGB14, or RGBNIR14 with a second layer (LAZ, "RGB14", "RGBNIR14").
template <class Layer>
class Colours {
 public:
  Colours(ChannelRule rule, unsigned channel, const std::byte* first, std::span<Layer> layers)
      : layers_(layers), channels_(rule, channel, read_colour(has_nir(), first), ColourModels()) {}

  void code(unsigned channel, bool changed_channel, ItemByte<Layer>* item) {
    const auto chosen = channels_.choose(channel, changed_channel);
    ColourValue& last = chosen.last;
    ColourValue now = last;
    if constexpr (Layer::kEncodes) now = read_colour(has_nir(), item);
    layers_[0].code(last.rgb, now.rgb,
                    [&](auto& coder) { chosen.models.rgb.code(coder, last.rgb, now.rgb); });
    if (has_nir()) {
      layers_[1].code(last.nir, now.nir,
                      [&](auto& coder) { chosen.models.nir.code(coder, last.nir, now.nir); });
    }
    last = now;
    if constexpr (!Layer::kEncodes) std::memcpy(item, &now, has_nir() ? sizeof now : sizeof now.rgb);
  }

 private:
  bool has_nir() const { return layers_.size() > 1; }

  std::span<Layer> layers_;
  ChannelValues<ColourValue, ColourModels> channels_;
};

template <class Layer>
class Wavepacket14 {
 public:
  Wavepacket14(ChannelRule rule, unsigned channel, const std::byte* first, Layer& layer)
      : layer_(layer), channels_(rule, channel, load<Wavepacket>(first), WavepacketModels()) {}

  void code(unsigned channel, bool changed_channel, ItemByte<Layer>* item) {
    const auto chosen = channels_.choose(channel, changed_channel);
    Wavepacket now = chosen.last;
    if constexpr (Layer::kEncodes) now = load<Wavepacket>(item);
    layer_.code(chosen.last, now, [&](auto& coder) { chosen.models.code(coder, chosen.last, now); });
    chosen.last = now;
    if constexpr (!Layer::kEncodes) store(item, now);
  }

 private:
  Layer& layer_;
  ChannelValues<Wavepacket, WavepacketModels> channels_;
};

// BYTE14: a layer for each byte.
template <class Layer>
class ExtraBytes14 {
 public:
  ExtraBytes14(ChannelRule rule, unsigned channel, std::span<const std::byte> first, std::span<Layer> layers)
      : layers_(layers),
        channels_(rule, channel, std::vector<std::byte>(first.begin(), first.end()),
                  std::vector<SymbolModel<256>>(first.size())) {}

  void code(unsigned channel, bool changed_channel, ItemByte<Layer>* item) {
    const auto chosen = channels_.choose(channel, changed_channel);
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      std::byte& last = chosen.last[i];
      if constexpr (!Layer::kEncodes) item[i] = last;
      layers_[i].code(last, item[i],
                      [&](auto& coder) { code_extra_byte(coder, chosen.models[i], last, item[i]); });
    }
  }

 private:
  std::span<Layer> layers_;
  ChannelValues<std::vector<std::byte>, std::vector<SymbolModel<256>>> channels_;
};

std::size_t layers_of(const Item& item) {
  switch (item.type) {
    case item_type::kPoint14:
      return Point14<DecodedLayer>::kLayers;
    case item_type::kRgb14:
    case item_type::kWavepacket14:
      return 1;
    case item_type::kRgbNir14:
      return 2;
    default:
      return item.size;
  }
}

// The records of a chunk after the first.
template <class Layer>
class Records {
 public:
  Records(const Layout& layout, std::span<const std::byte> first, std::span<Layer> layers)
      : point_(first.data(), layers.template first<Point14<Layer>::kLayers>()) {
    const ChannelRule rule = layout.items[0].version == 3 ? ChannelRule::kVersion3 : ChannelRule::kVersion4;
    std::size_t at = 0;
    for (const Item& item : layout.items) {
      const std::span<Layer> own = layers.first(layers_of(item));
      if (item.type == item_type::kRgb14 || item.type == item_type::kRgbNir14) {
        colours_.emplace(rule, point_.channel(), &first[at], own);
        colours_at_ = at;
      } else if (item.type == item_type::kWavepacket14) {
        wavepackets_.emplace(rule, point_.channel(), &first[at], own[0]);
        wavepackets_at_ = at;
      } else if (item.type == item_type::kByte14) {
        extra_bytes_.emplace(rule, point_.channel(), first.subspan(at, item.size), own);
        extra_bytes_at_ = at;
      }
      layers = layers.subspan(own.size());
      at += item.size;
    }
  }

  void code(ItemByte<Layer>* record) {
    point_.code(record);
    const unsigned channel = point_.channel();
    const bool changed = point_.changed_channel();
    if (colours_) colours_->code(channel, changed, record + colours_at_);
    if (wavepackets_) wavepackets_->code(channel, changed, record + wavepackets_at_);
    if (extra_bytes_) extra_bytes_->code(channel, changed, record + extra_bytes_at_);
  }

 private:
  Point14<Layer> point_;
  std::optional<Colours<Layer>> colours_;
  std::optional<Wavepacket14<Layer>> wavepackets_;
  std::optional<ExtraBytes14<Layer>> extra_bytes_;
  std::size_t colours_at_ = 0, wavepackets_at_ = 0, extra_bytes_at_ = 0;
};

// Reads the layers of a chunk. From `begin` on, it has the number of points, the size of each layer, and the
// layers. Numbers have 4 bytes.
std::vector<DecodedLayer> read_layers(const ChunkBytes& bytes, std::uint64_t begin, std::size_t count) {
  const std::uint64_t sizes_at = begin + kNumberBytes;
  std::uint64_t at = sizes_at + kNumberBytes * count;
  const std::vector<std::byte> sizes = read_all(bytes, sizes_at, at);
  std::vector<DecodedLayer> layers(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t size = load<std::uint32_t>(&sizes[kNumberBytes * i]);
    if (size > bytes.size() - at) throw Corrupt("a layer of compressed points is cut");
    if (size > 0) layers[i].decoder.emplace(bytes, at, at + size);
    at += size;
  }
  return layers;
}

class LayeredDecoder final : public RecordDecoder {
 public:
  LayeredDecoder(const Layout& layout, const ChunkBytes& bytes, std::span<const std::byte> first)
      : record_bytes_(first.size()),
        points_(load<std::uint32_t>(read_all(bytes, record_bytes_, record_bytes_ + kNumberBytes).data())),
        layers_(read_layers(bytes, record_bytes_, layer_count(layout))),
        records_(layout, first, layers_) {}

  void decode(std::span<std::byte> records) override {
    for (std::size_t at = 0; at < records.size(); at += record_bytes_) records_.code(records.data() + at);
  }

  bool has_other_than(std::uint64_t points) const override { return points_ > points; }

 private:
  std::size_t record_bytes_;
  std::uint64_t points_;
  std::vector<DecodedLayer> layers_;
  Records<DecodedLayer> records_;
};

}  // namespace

std::size_t layer_count(const Layout& layout) {
  std::size_t count = 0;
  for (const Item& item : layout.items) count += layers_of(item);
  return count;
}

std::unique_ptr<RecordDecoder> layered_decoder(const Layout& layout, const ChunkBytes& bytes,
                                               std::span<const std::byte> first) {
  return std::make_unique<LayeredDecoder>(layout, bytes, first);
}

std::vector<std::byte> layered_chunk(const Layout& layout, std::span<const std::byte> records) {
  const std::size_t record_bytes = layout.record_bytes();
  const auto first = records.first(record_bytes);
  std::vector<EncodedLayer> layers(layer_count(layout));
  Records<EncodedLayer> encoder(layout, first, layers);
  for (std::size_t at = record_bytes; at < records.size(); at += record_bytes)
    encoder.code(records.data() + at);

  std::vector<std::byte> chunk(first.begin(), first.end());
  std::size_t number_at = chunk.size();
  chunk.insert(chunk.end(), kNumberBytes * (1 + layers.size()), std::byte{0});
  const auto put = [&](std::size_t number) {
    store(&chunk[number_at], static_cast<std::uint32_t>(number));
    number_at += kNumberBytes;
  };
  put(records.size() / record_bytes);
  for (EncodedLayer& layer : layers) {
    const std::vector<std::byte> bytes = layer.finish();
    put(bytes.size());
    chunk.insert(chunk.end(), bytes.begin(), bytes.end());
  }
  return chunk;
}

}  // namespace lacuna::io::laz
