#include <algorithm>

#include "naming.hpp"
#include "quadcore/plugin.hpp"

namespace quadcore::rotors {
namespace {

/// Forwards rotor speeds from controllers to the motors with a delay of one step.
class ControllerInterface final : public Plugin {
 public:
  explicit ControllerInterface(const PluginSetup& setup)
      : in_(setup.topics.takes(topic_of(setup, "commandMotorSpeedSubTopic"),
                               messages::speeds(motor_count(setup.model)))),
        out_(setup.topics.publishes(topic_of(setup, "motorSpeedCommandPubTopic"),
                                    messages::speeds(motor_count(setup.model)))) {}

  std::size_t state_size() const override { return 1; }

  void update(const Sample& sample, PluginState heard) const override {
    const Topic& command = sample.topics[in_];
    if (command.count == heard[0]) return;
    heard[0] = command.count;
    const std::vector<double>& speeds = command.values;
    std::copy(speeds.begin(), speeds.end(), sample.topics.publish(out_, sample.time));
  }

 private:
  std::size_t in_, out_;  ///< topics
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "RotorS' controller interface: forwards rotor speeds from controllers to motors, one step "
      "later",
      {
          T::text("commandMotorSpeedSubTopic", "command/motor_speed",
                  "topic of the controllers' rotor speeds, rad/s, in the motors' order")
              .from("RotorS"),
          T::text("motorSpeedCommandPubTopic", "gazebo/command/motor_speed",
                  "topic of the forwarded rotor speeds")
              .from("RotorS"),
          idle("commandAttitudeThrustSubTopic", "RotorS does not use it either"),
          idle("commandRateThrustSubTopic", "RotorS does not use it either"),
          idle("imuSubTopic", "RotorS does not use it either"),
          namespace_tag(),
      },
      {},
      create<ControllerInterface>,
  };
}

}  // namespace
}  // namespace quadcore::rotors

QUADCORE_REGISTER_PLUGIN(quadcore::rotors::describe)
