#include <algorithm>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/random.hpp"
#include "shared/sensing.hpp"

namespace quadcore::tachometer {
namespace {

/// Measures the speeds of rotors in the units and signs of their commands.
class TachometerPlugin final : public Plugin {
 public:
  explicit TachometerPlugin(const PluginSetup& setup)
      : rotors_(setup.parameters.joints("rotorJoints")),
        speed_per_rate_(rotors_.size(), 1),
        noise_(setup.parameters.number("noise")),
        rate_(setup.parameters.number("rate")),
        channel_(setup, messages::speeds(rotors_.size())) {}

  std::size_t state_size() const override {
    return kSpeeds + rotors_.size() + channel_.state_size();
  }

  void prepare(const VehicleDescription& vehicle) override {
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      const double rate_per_command = vehicle.rotors[rotors_[i]].rate_per_command;
      // A motor that ignores its command has no commanded speed: the joint rate stands for it.
      speed_per_rate_[i] = rate_per_command == 0 ? 1 : 1 / rate_per_command;
    }
  }

  void sense(const Sample& sample, PluginState state) const override {
    double* const speeds = state.data() + kSpeeds;
    double* const end = speeds + rotors_.size();
    PluginState on_the_way(end, state.data() + state.size() - end);
    if (rate_.is_due(sample, state[kSamples])) {
      for (std::size_t i = 0; i < rotors_.size(); ++i) {
        const double rate = sample.kinematics.rotors.number(MotionRow::rate, rotors_[i]);
        speeds[i] = speed_per_rate_[i] * rate + noise_ * random_normal(sample.seed, state[kDraws]);
      }
      channel_.send_row(sample, on_the_way, [&](double* row) { std::copy(speeds, end, row); });
    }
    channel_.deliver(sample, on_the_way);
  }

 private:
  /// Time of measurement, number of random numbers drawn, and measured speeds; then the messages in
  /// the Channel.
  enum Memory { kSamples, kDraws, kSpeeds };

  std::vector<std::size_t> rotors_;
  std::vector<double> speed_per_rate_;  ///< commanded speed divided by the joint rate
  double noise_;                        ///< rad/s
  sensing::Rate rate_;
  sensing::Channel channel_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "tachometers of the rotors",
      {
          T::number("rate", "1/s", "500", "messages per second; at most one per step").above(0),
          T::text("topic", "rotor_speeds", "topic of the messages"),
          T::number("noise", "rad/s", "0", "standard deviation of the white noise of each speed")
              .at_least(0),
          sensing::Channel::delay_tag(),
          sensing::Channel::dropout_tag(),
          T::joints("rotorJoints", "the measured rotors, in the order of the message"),
      },
      {},
      create<TachometerPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::tachometer

QUADCORE_REGISTER_PLUGIN(quadcore::tachometer::describe)
