#include <cmath>
#include <quadcore/plugin.hpp>

namespace {

using quadcore::Effect;
using quadcore::TagSpec;

/// A third party's motors and propellers in one: joints that turn four times slower than their
/// propellers, at once, and the other way round where the joint's number is odd.
class OwnMotorPlugin final : public quadcore::Plugin {
 public:
  explicit OwnMotorPlugin(const quadcore::PluginSetup& setup)
      : rotors_(setup.model.joints.size()),
        thrust_(setup.parameters.number("ownThrust")),
        torque_(setup.parameters.number("ownTorque")),
        command_(setup.topics.takes("vel_cmd", quadcore::messages::speeds(rotors_))) {}

  std::size_t state_size() const override { return rotors_; }

  void describe_rotors(std::vector<quadcore::RotorDescription>& rotors) const override {
    for (std::size_t i = 0; i < rotors_; ++i) {
      rotors[i].rate_per_command = turn(i) / slowdown;
      rotors[i].fastest = 1000;
      rotors[i].place = static_cast<int>(rotors_ - 1 - i);
      rotors[i].spin = turn(i);
      rotors[i].prescribed = true;
    }
  }

  void update(const quadcore::Sample& sample, quadcore::PluginState state) const override {
    const std::vector<double>& speeds = sample.topics[command_].values;
    for (std::size_t i = 0; i < rotors_; ++i) {
      const double speed = std::fmin(speeds[rotors_ - 1 - i], 1000);
      state[static_cast<Eigen::Index>(i)] = turn(i) * speed / slowdown;
    }
  }

  void forces(const quadcore::Kinematics& k, quadcore::ConstPluginState state,
              quadcore::Loads& loads) const override {
    for (std::size_t i = 0; i < rotors_; ++i) {
      const quadcore::RotorKinematics rotor = k.rotors[i];
      const double speed = slowdown * rotor.rate;
      loads.add_rotor_force(0, i, thrust_ * speed * speed * rotor.axis_F);
      loads.add_frame_torque(1, -torque_ * speed * std::abs(speed) * rotor.axis_F);
      loads.prescribe_joint_rate(i, {state[static_cast<Eigen::Index>(i)], 0, false});
    }
  }

 private:
  static constexpr double slowdown = 4;
  static double turn(std::size_t i) { return i % 2 == 0 ? 1 : -1; }

  std::size_t rotors_;
  double thrust_, torque_;
  std::size_t command_;
};

quadcore::PluginDescriptor describe() {
  return {"motors and propellers of a third party",
          {TagSpec::number("ownThrust", "N s^2/rad^2", "2e-5", "thrust per squared speed")
               .scaling(Effect::thrust),
           TagSpec::number("ownTorque", "N m s^2/rad^2", "3e-7", "drag torque per squared speed")
               .scaling(Effect::thrust)},
          {"own_thrust", "own_torque"},
          quadcore::create<OwnMotorPlugin>};
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
