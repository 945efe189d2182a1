// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/number.hpp"
#include "io/read/laz/chunks.hpp"
#include "io/read/laz/items.hpp"
#include "io/read/laz/point14.hpp"

#include <array>
#include <cstring>
#include <optional>

namespace lacuna::io::laz {
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
