// SPDX-License-Identifier: Apache-2.0
// The last values and the models of colours and extra bytes, for each scanner channel.
#pragma once

#include <array>
#include <optional>

namespace lacuna::io::laz {

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

}  // namespace lacuna::io::laz
