#include <optional>

#include "naming.hpp"
#include "quadcore/plugin.hpp"

namespace quadcore::rotors {
namespace {

/// Publishes the rotor speeds before this step's motor torques act. For quadcore's controllers, it
/// also publishes the motion of the frame unless a quadcore odometry plugin does.
class MultirotorBase final : public Plugin {
 public:
  explicit MultirotorBase(const PluginSetup& setup)
      : rotors_(setup.model.joints.size()),
        slowdown_(setup.parameters.number("rotorVelocitySlowdownSim")),
        topic_(
            setup.topics.publishes(topic_of(setup, "motorPubTopic"), messages::speeds(rotors_))) {
    const auto& plugins = setup.model.plugins;
    const bool has_odometry =
        std::any_of(plugins.begin(), plugins.end(),
                    [](const PluginElement& p) { return p.filename == "libodometry_plugin.so"; });
    if (has_odometry) return;
    odometry_ = setup.topics.publishes(setup.parameters.text("truth"),
                                       messages::kind_of<messages::Odometry>());
  }

  void update(const Sample& sample, PluginState) const override {
    double* speeds = sample.topics.publish(topic_, sample.time);
    for (std::size_t i = 0; i < rotors_; ++i) {
      speeds[i] = sample.kinematics.rotors.number(MotionRow::rate, i) * slowdown_;
    }
  }

  void sense(const Sample& sample, PluginState) const override {
    if (!odometry_) return;
    const Kinematics& k = sample.kinematics;
    messages::Odometry message;
    message.position = k.p_WF;
    message.orientation = k.q_WF;
    message.linear_velocity = k.R_WF * k.v_WF_F;
    message.angular_velocity = k.w_WF_F;
    sample.topics.publish(*odometry_, sample.time, message);
  }

 private:
  std::size_t rotors_;
  double slowdown_;
  std::size_t topic_;
  std::optional<std::size_t> odometry_;  ///< topic
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "RotorS' base plugin: publishes the rotor speeds",
      {
          T::number("rotorVelocitySlowdownSim", "", "10",
                    "factor by which the published joint rates are multiplied")
              .above(0)
              .from("RotorS"),
          T::text("motorPubTopic", "motor_speed",
                  "topic of the signed rotor speeds, in the joints' order")
              .from("RotorS"),
          T::text("truth", "odom",
                  "quadcore extension: topic of the frame's exact pose and velocity for quadcore's "
                  "controllers, with the linear velocity in world axes; unused if the model has a "
                  "libodometry_plugin.so"),
          T::flag("publishTf", "true",
                  "quadcore extension: whether the ROS node also publishes the frame's pose on tf"),
          idle("jointStatePubTopic", "the ROS node publishes joint_states itself"),
          T::link("linkName", "frame_id of the rotor speeds in the ROS node").from("RotorS"),
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
