#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/counts.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/random.hpp"

/// \file
/// Common parts of sensors: timing, noise, and the transmission of measurements.

namespace quadcore::sensing {

inline Vector3d normal_vector(std::uint64_t seed, double& draws) {
  Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = random_normal(seed, draws);
  return v;
}

/// Timing of a sensor: it measures at most once per step, and whenever the motion is set. Its
/// memory is one number.
class Rate {
 public:
  explicit Rate(double rate) : rate_(rate) {}

  bool is_due(const Sample& sample, double& memory) const {
    const double due = std::floor(sample.time * rate_ + 1e-6) + 1;
    if (due == memory && !sample.jumped) return false;
    memory = due;
    return true;
  }

 private:
  double rate_;  ///< 1/s
};

/// Transmission from a sensor to its topic with losses and a delay. A message contains the time of
/// its measurement. The first one after the motion was set arrives at once.
class Channel {
 public:
  /// Create from the tags `topic`, `rate`, `delay` and `dropout`.
  Channel(const PluginSetup& setup, const MessageKind& kind)
      : topic_(setup.topics.publishes(setup.parameters.text("topic"), kind)),
        row_(kind.fields.size() + 1),
        delay_(setup.parameters.number("delay")),
        dropout_(setup.parameters.number("dropout")) {
    // A message arrives at the first end of a step at which it is old enough.
    const double waiting = std::ceil((delay_ + 2 * setup.dt) *
                                         std::min(setup.parameters.number("rate"), 1 / setup.dt) +
                                     1e-6) +
                           1;
    if (waiting * static_cast<double>(row_) > most_numbers) {
      throw InputError("<delay> is too long for the message buffer. Use a shorter delay.");
    }
    places_ = delay_ > 0 ? static_cast<std::size_t>(waiting) : 0;
  }

  std::size_t state_size() const { return kRing + places_ * row_; }

  /// Return the index of the topic.
  std::size_t topic() const { return topic_; }
  /// Return whether every message arrives at once.
  bool is_direct() const { return delay_ == 0 && dropout_ == 0; }

  template <class M>
  void send(const Sample& sample, PluginState memory, const M& message) const {
    send_row(sample, memory, [&message](double* row) { messages::write(message, row); });
  }
  /// Send a message whose numbers `write(double* row)` writes.
  template <class Write>
  void send_row(const Sample& sample, PluginState memory, const Write& write) const {
    if (is_direct()) return write(sample.topics.publish(topic_, sample.time));
    if (sample.jumped) {
      clear(memory);
    } else if (dropout_ > 0 && uniform(sample.seed, memory[kDraws]) < dropout_) {
      return;
    }
    if (sample.jumped || delay_ == 0) return write(sample.topics.publish(topic_, sample.time));
    double* row = at(memory, memory[kFirst] + memory[kWaiting]);
    row[0] = sample.time;
    write(row + 1);
    memory[kWaiting] += 1;
  }

  /// Discard pending messages because the motion was set.
  void clear(PluginState memory) const {
    if (!is_direct()) memory[kWaiting] = 0;
  }

  /// Publish the messages that have arrived; called at the end of each step.
  void deliver(const Sample& sample, PluginState memory) const {
    if (delay_ == 0) return;
    for (auto waiting = count_of(memory[kWaiting], places_); waiting > 0; --waiting) {
      const double* row = at(memory, memory[kFirst]);
      if (sample.time < row[0] + delay_ - 1e-9) return;  // the time is a sum of steps
      std::copy_n(row + 1, row_ - 1, sample.topics.publish(topic_, row[0]));
      memory[kFirst] = static_cast<double>(ring_index(memory[kFirst] + 1, places_));
      memory[kWaiting] -= 1;
    }
  }

  static TagSpec delay_tag() {
    return TagSpec::number(
               "delay", "s", "0",
               "age of a message when it arrives; its stamp is the time it was measured")
        .at_least(0);
  }
  static TagSpec dropout_tag() {
    return TagSpec::number("dropout", "", "0", "probability that a message is lost")
        .at_least(0)
        .at_most(1);
  }

 private:
  /// Number of random numbers drawn, index of the oldest pending message, and number of pending
  /// messages; then the entries, each a time and a message.
  enum Memory : std::size_t { kDraws, kFirst, kWaiting, kRing };
  static constexpr double most_numbers = 500000;

  static double uniform(std::uint64_t seed, double& draws) {
    const std::uint64_t bits = random_bits(stream_seed(seed, "dropout"), count_of(draws));
    draws += 1;
    return static_cast<double>(bits >> 11) / 9007199254740992.0;  // 2^53
  }
  double* at(PluginState& memory, double place) const {
    return memory.data() + kRing + ring_index(place, places_) * row_;
  }

  std::size_t topic_;
  std::size_t row_, places_;  ///< size of an entry, and number of entries
  double delay_;              ///< s
  double dropout_;
};

}  // namespace quadcore::sensing
