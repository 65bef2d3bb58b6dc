#include "naming.hpp"
#include "quadcore/plugin.hpp"

namespace quadcore::rotors {
namespace {

/// Tells how fast the rotors turn, as they do before this step's motors act.
class MultirotorBase final : public Plugin {
 public:
  explicit MultirotorBase(const PluginSetup& setup)
      : rotors_(setup.model.joints.size()),
        slowdown_(setup.parameters.number("rotorVelocitySlowdownSim")),
        topic_(setup.topics.publishes(topic_word(setup.parameters.text("motorPubTopic")),
                                      messages::speeds(rotors_))) {}

  void update(const Sample& sample, PluginState) const override {
    double* speeds = sample.topics.publish(topic_, sample.time);
    for (std::size_t i = 0; i < rotors_; ++i) {
      speeds[i] = sample.kinematics.rotors.number(MotionRow::rate, i) * slowdown_;
    }
  }

 private:
  std::size_t rotors_;
  double slowdown_;
  std::size_t topic_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "RotorS' base: publishes the speeds of the rotors",
      {
          T::number("rotorVelocitySlowdownSim", "", "10", "rates of the joints are told times this")
              .above(0)
              .from("RotorS"),
          T::text("motorPubTopic", "motor_speed",
                  "where the rotors' speeds are published, signed, in the joints' order, / being _")
              .from("RotorS"),
          idle("jointStatePubTopic", "a ROS node publishes joint_states by itself"),
          idle("linkName", "every continuous joint of the model is told"),
          idle("frameId", "speeds have no frame"),
          namespace_tag(),
      },
      {},
      create<MultirotorBase>,
  };
}

}  // namespace
}  // namespace quadcore::rotors

QUADCORE_REGISTER_PLUGIN(quadcore::rotors::describe)
