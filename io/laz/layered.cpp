// SPDX-License-Identifier: Apache-2.0
#include "io/laz/layered.hpp"

#include "io/laz/layered_channels.hpp"
#include "io/laz/point14.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>

namespace lacuna::io::laz {
namespace {

// Decodes RGB14, and RGBNIR14 if `has_nir` (LAZ, "RGB14", "RGBNIR14").
class ColourDecoder {
 public:
  ColourDecoder(bool has_nir, ChannelRule rule, unsigned channel, const std::byte* first, Layers& layers)
      : has_nir_(has_nir), channels_(rule, channel, read_colour(has_nir, first), ColourModels()) {
    rgb_ = layers.next();
    if (has_nir_) nir_ = layers.next();
  }

  void decode(unsigned channel, bool changed_channel, std::byte* item) {
    const auto [last, models] = channels_.choose(channel, changed_channel);
    if (rgb_) last.rgb = models.rgb.decode(*rgb_, last.rgb);
    if (nir_) last.nir = models.nir.decode(*nir_, last.nir);
    std::memcpy(item, &last, colour_bytes(has_nir_));
  }

 private:
  bool has_nir_;
  Layer rgb_, nir_;
  ColourChannels channels_;
};

// BYTE14: a layer for each byte, of differences to the same byte of the last point (LAZ, "BYTE14").
class BytesDecoder {
 public:
  BytesDecoder(ChannelRule rule, unsigned channel, std::span<const std::byte> first, Layers& layers)
      : channels_(byte_channels(rule, channel, first)) {
    for (std::size_t i = 0; i < first.size(); ++i) layers_.push_back(layers.next());
  }

  void decode(unsigned channel, bool changed_channel, std::byte* item) {
    const auto [last, models] = channels_.choose(channel, changed_channel);
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      if (layers_[i]) {
        last[i] = static_cast<std::byte>(std::to_integer<unsigned>(last[i]) + layers_[i]->symbol(models[i]));
      }
    }
    std::copy(last.begin(), last.end(), item);
  }

 private:
  std::vector<Layer> layers_;
  ByteChannels channels_;
};

class LayeredDecoder final : public RecordDecoder {
 public:
  LayeredDecoder(const Layout& layout, const ChunkBytes& bytes, std::span<const std::byte> first)
      : record_bytes_(first.size()),
        layers_(bytes, record_bytes_, layer_count(layout)),
        point_(first.data(), layers_) {
    const ChannelRule rule = channel_rule(layout);
    std::size_t at = 0;
    for (const Item& item : layout.items) {
      if (item.type == item_type::kRgb14 || item.type == item_type::kRgbNir14) {
        const bool has_nir = item.type == item_type::kRgbNir14;
        colour_.emplace(has_nir, rule, point_.channel(), &first[at], layers_);
        colour_at_ = at;
      } else if (item.type == item_type::kByte14) {
        extra_bytes_.emplace(rule, point_.channel(), first.subspan(at, item.size), layers_);
        extra_bytes_at_ = at;
      }
      at += item.size;
    }
  }

  void decode(std::span<std::byte> records) override {
    for (std::size_t at = 0; at < records.size(); at += record_bytes_) {
      std::byte* const to = records.data() + at;
      point_.decode(to);
      const unsigned channel = point_.channel();
      const bool changed = point_.changed_channel();
      if (colour_) colour_->decode(channel, changed, to + colour_at_);
      if (extra_bytes_) extra_bytes_->decode(channel, changed, to + extra_bytes_at_);
    }
  }

 private:
  std::size_t record_bytes_;
  Layers layers_;
  Point14Decoder point_;
  std::optional<ColourDecoder> colour_;
  std::optional<BytesDecoder> extra_bytes_;
  std::size_t colour_at_ = 0, extra_bytes_at_ = 0;
};

}  // namespace

std::size_t layer_count(const Layout& layout) {
  std::size_t count = point14::kLayers;
  for (const Item& item : layout.items) {
    if (item.type == item_type::kRgb14) count += 1;
    if (item.type == item_type::kRgbNir14) count += 2;
    if (item.type == item_type::kByte14) count += item.size;
  }
  return count;
}

std::unique_ptr<RecordDecoder> layered_decoder(const Layout& layout, const ChunkBytes& bytes,
                                               std::span<const std::byte> first) {
  return std::make_unique<LayeredDecoder>(layout, bytes, first);
}

}  // namespace lacuna::io::laz
