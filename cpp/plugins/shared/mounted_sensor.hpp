#pragma once

#include <cstddef>
#include <optional>

#include "quadcore/plugin.hpp"
#include "shared/sensing.hpp"

namespace quadcore::sensing {

/// A sensor on the vehicle that measures at the `rate` of its tag and sends messages of one type
/// through a Channel. Its state consists of the time of measurement, N numbers for measure(), and
/// the messages in the Channel.
template <class Message, Eigen::Index N>
class MountedSensor : public Plugin {
 public:
  explicit MountedSensor(const PluginSetup& setup)
      : rate_(setup.parameters.number("rate")), channel_(setup, messages::kind_of<Message>()) {}

  std::size_t state_size() const override { return kMemory + N + channel_.state_size(); }

  void sense(const Sample& sample, PluginState state) const override {
    PluginState on_the_way(state.data() + kMemory + N, state.size() - kMemory - N);
    if (is_due(sample, state)) {
      const std::optional<Message> message =
          measure(sample, PluginState(state.data() + kMemory, N));
      if (message) {
        channel_.send(sample, on_the_way, *message);
      } else {
        channel_.clear(on_the_way);
      }
    }
    channel_.deliver(sample, on_the_way);
  }

 protected:
  /// Return the pose in the frame of the link that the tag `link` names.
  static Pose mounting(const PluginSetup& setup) {
    return setup.model.pose_of_link.at(setup.parameters.choice("link"));
  }

  /// Return whether the sensor measures now, once for each sample.
  bool is_due(const Sample& sample, PluginState state) const {
    return rate_.is_due(sample, state[kSamples]);
  }

  /// \param memory  N numbers, zero at the start
  /// \return the message, or none if the motion has just been set and cannot be measured
  virtual std::optional<Message> measure(const Sample& sample, PluginState memory) const = 0;

  const Channel& channel() const { return channel_; }

 private:
  enum Memory { kSamples, kMemory };

  Rate rate_;
  Channel channel_;
};

}  // namespace quadcore::sensing
