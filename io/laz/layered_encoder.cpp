// SPDX-License-Identifier: Apache-2.0
#include "io/files/little_endian.hpp"
#include "io/laz/layer_encoder.hpp"
#include "io/laz/layered.hpp"
#include "io/laz/layered_channels.hpp"
#include "io/laz/point14_encoder.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace lacuna::io::laz {
namespace {

// Encodes RGB14, and RGBNIR14 if `has_nir` (LAZ, "RGB14", "RGBNIR14").
class ColourEncoder {
 public:
  ColourEncoder(bool has_nir, ChannelRule rule, unsigned channel, const std::byte* first)
      : has_nir_(has_nir), channels_(rule, channel, read_colour(has_nir, first), ColourModels()) {}

  void encode(unsigned channel, bool changed_channel, const std::byte* item) {
    const auto [last, models] = channels_.choose(channel, changed_channel);
    const Colour now = read_colour(has_nir_, item);
    models.rgb.encode(layers_[0].encoder, last.rgb, now.rgb);
    layers_[0].note(last.rgb != now.rgb);
    if (has_nir_) {
      models.nir.encode(layers_[1].encoder, last.nir, now.nir);
      layers_[1].note(last.nir != now.nir);
    }
    last = now;
  }

  std::span<LayerEncoder> layers() { return std::span(layers_).first(has_nir_ ? 2 : 1); }

 private:
  bool has_nir_;
  std::array<LayerEncoder, 2> layers_;
  ColourChannels channels_;
};

// BYTE14: a layer for each byte, of differences to the same byte of the last point (LAZ, "BYTE14").
class BytesEncoder {
 public:
  BytesEncoder(ChannelRule rule, unsigned channel, std::span<const std::byte> first)
      : layers_(first.size()), channels_(byte_channels(rule, channel, first)) {}

  void encode(unsigned channel, bool changed_channel, const std::byte* item) {
    const auto [last, models] = channels_.choose(channel, changed_channel);
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const unsigned before = std::to_integer<unsigned>(last[i]), now = std::to_integer<unsigned>(item[i]);
      layers_[i].encoder.symbol(models[i], (now - before) & 255);
      layers_[i].note(now != before);
      last[i] = item[i];
    }
  }

  std::span<LayerEncoder> layers() { return layers_; }

 private:
  std::vector<LayerEncoder> layers_;
  ByteChannels channels_;
};

class LayeredEncoder {
 public:
  LayeredEncoder(const Layout& layout, std::span<const std::byte> first) : point_(first.data()) {
    const ChannelRule rule = channel_rule(layout);
    std::size_t at = 0;
    for (const Item& item : layout.items) {
      if (item.type == item_type::kRgb14 || item.type == item_type::kRgbNir14) {
        colour_.emplace(item.type == item_type::kRgbNir14, rule, point_.channel(), &first[at]);
        colour_at_ = at;
      } else if (item.type == item_type::kByte14) {
        extra_bytes_.emplace(rule, point_.channel(), first.subspan(at, item.size));
        extra_bytes_at_ = at;
      }
      at += item.size;
    }
  }

  void encode(const std::byte* record) {
    point_.encode(record);
    const unsigned channel = point_.channel();
    const bool changed = point_.changed_channel();
    if (colour_) colour_->encode(channel, changed, record + colour_at_);
    if (extra_bytes_) extra_bytes_->encode(channel, changed, record + extra_bytes_at_);
  }

  // Layers are in the order of the chunk.
  std::vector<LayerEncoder*> layers() {
    std::vector<LayerEncoder*> layers;
    const auto add = [&](std::span<LayerEncoder> more) {
      for (LayerEncoder& layer : more) layers.push_back(&layer);
    };
    add(point_.layers());
    if (colour_) add(colour_->layers());
    if (extra_bytes_) add(extra_bytes_->layers());
    return layers;
  }

 private:
  Point14Encoder point_;
  std::optional<ColourEncoder> colour_;
  std::optional<BytesEncoder> extra_bytes_;
  std::size_t colour_at_ = 0, extra_bytes_at_ = 0;
};

}  // namespace

std::vector<std::byte> layered_chunk(const Layout& layout, std::span<const std::byte> records) {
  const std::size_t record_bytes = layout.record_bytes();
  const auto first = records.first(record_bytes);
  LayeredEncoder encoder(layout, first);
  for (std::size_t at = record_bytes; at < records.size(); at += record_bytes)
    encoder.encode(records.data() + at);

  // The first point, the number of points, the size of each layer, the layers.
  constexpr std::size_t kNumberBytes = 4;
  const std::vector<LayerEncoder*> layers = encoder.layers();
  std::vector<std::byte> chunk(first.begin(), first.end());
  std::size_t number_at = chunk.size();
  chunk.insert(chunk.end(), kNumberBytes * (1 + layers.size()), std::byte{0});
  const auto put = [&](std::size_t number) {
    store(&chunk[number_at], static_cast<std::uint32_t>(number));
    number_at += kNumberBytes;
  };
  put(records.size() / record_bytes);
  for (LayerEncoder* layer : layers) {
    const std::vector<std::byte> bytes = layer->finish();
    put(bytes.size());
    chunk.insert(chunk.end(), bytes.begin(), bytes.end());
  }
  return chunk;
}

}  // namespace lacuna::io::laz
