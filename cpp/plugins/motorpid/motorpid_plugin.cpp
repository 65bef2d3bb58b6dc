#include <algorithm>
#include <cmath>
#include <sstream>

#include "lanes/for_each_width.hpp"
#include "laws/motor_target.hpp"
#include "motor_torques.hpp"
#include "quadcore/force_laws.hpp"
#include "quadcore/lane_width.hpp"
#include "quadcore/law_interface.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/error.hpp"
#include "shared/rotor_shares.hpp"
#include "shared/speed_limit.hpp"

namespace quadcore::motorpid {
namespace {

struct Config {
  double kp, ki, kd, i_max, i_min, sim_slow;
  bool samples;            ///< whether the integral or the derivative acts
  double command_timeout;  ///< s; infinite without a timeout
  std::vector<std::size_t> rotors;

  explicit Config(const Parameters& p)
      : kp(p.number("kp")),
        ki(p.number("ki")),
        kd(p.number("kd")),
        i_max(p.number("iMax")),
        i_min(p.number("iMin")),
        sim_slow(p.number("sim_slow")),
        samples(ki != 0 || kd != 0),
        command_timeout(p.has("commandTimeout") ? p.number("commandTimeout") : INFINITY),
        rotors(p.joints("rotorJoints")) {}
};

/// PID on the joint velocity as run by Gazebo's JointController for the thesis' appendix A.4, in
/// slowed-down units: e = W - W_target, torque = -kp e - I - kd (e - e_previous)/dt with I = ki
/// sum(e dt) clamped to [iMin, iMax]. The proportional part is continuous and part of the force
/// law; integral and derivative are sampled once per step. Until the first command the motors turn
/// freely.
class MotorPidPlugin final : public Plugin {
 public:
  static constexpr const char* law_interface = quadcore::law_interface;

  explicit MotorPidPlugin(const PluginSetup& setup)
      : config_(setup.parameters),
        rotor_count_(setup.model.joints.size()),
        places_(rotor_count_, not_driven),
        topic_(setup.topics.takes("vel_cmd", messages::speeds(config_.rotors.size()))),
        power_(setup.topics.takes(setup.parameters.text("power"), shares(config_.rotors.size()))),
        limit_(setup) {
    for (std::size_t j = 0; j < config_.rotors.size(); ++j) {
      places_[config_.rotors[j]] = static_cast<int>(j);
    }
    static constexpr laws::ForEachWidth<void(const MotorTorques&, const RotorLanes&)> widths{
        &add_motor_torques<1>, &add_motor_torques<2>, &add_motor_torques<4>, &add_motor_torques<8>};
    add_ = widths[lane_width()];
    if (config_.i_min > config_.i_max) throw InputError("<iMin> exceeds <iMax>. Swap them.");
    if (config_.ki != 0 && config_.i_min == 0 && config_.i_max == 0) {
      setup.warnings.push_back(
          "<ki> has no effect while <iMax> and <iMin> are 0, as in the thesis. Set them to the "
          "maximum and minimum integral torque in N m.");
    }
    for (const std::size_t i : config_.rotors) {
      warn_if_stiff(setup, i);
      dampings_.push_back(setup.model.joints[i].damping);
    }
  }

  std::size_t state_size() const override {
    return RotorRows<MemoryRow::count>::size_of(rotor_count_);
  }

  void describe_rotors(std::vector<RotorDescription>& rotors) const override {
    for (std::size_t j = 0; j < config_.rotors.size(); ++j) {
      RotorDescription& rotor = rotors[config_.rotors[j]];
      const double stiffness = config_.kp + dampings_[j];
      rotor.rate_per_command = stiffness > 0 ? config_.kp / stiffness / config_.sim_slow : 0;
      rotor.lag = stiffness > 0 ? rotor.moment / stiffness : 0;
      rotor.fastest = limit_.fastest();
      rotor.place = static_cast<int>(j);
    }
  }

  void update(const Sample& sample, PluginState state) const override {
    const Topic& command = sample.topics[topic_];
    if (command.count == 0) return;
    const bool stale = sample.time - command.stamp > config_.command_timeout;
    const Topic& power = sample.topics[power_];
    // The counts only increase, so a message on either topic changes this number.
    const double number = stale ? -1 - power.count : command.count + power.count;
    if (!stale) limit_.count(sample, command.values);
    for (std::size_t j = 0; j < config_.rotors.size(); ++j) {
      const std::size_t i = config_.rotors[j];
      double* rows = state.data() + rotor_offset(MemoryRow::count, i);
      const auto memory = [rows](std::size_t row) -> double& { return rows[row * widest_lanes]; };
      if (memory(MemoryRow::followed) == number && !config_.samples)
        return;  // the same for all rotors
      if (j == 0) check_shares(power, sample.time);
      memory(MemoryRow::followed) = number;
      const double wanted = stale ? 0 : command.values[j];
      memory(MemoryRow::active) = power.values[j];
      memory(MemoryRow::target) = laws::motor_target(wanted, limit_.fastest(), config_.sim_slow);
      if (!config_.samples || memory(MemoryRow::active) == 0) continue;
      const double error =
          sample.kinematics.rotors.number(MotionRow::rate, i) - memory(MemoryRow::target);
      memory(MemoryRow::error_sum) += sample.dt * error;
      double integral = config_.ki * memory(MemoryRow::error_sum);
      if (integral > config_.i_max || integral < config_.i_min) {
        integral = std::clamp(integral, config_.i_min, config_.i_max);
        memory(MemoryRow::error_sum) = integral / config_.ki;
      }
      const double derivative = config_.kd * (error - memory(MemoryRow::last_error)) / sample.dt;
      memory(MemoryRow::last_error) = error;
      memory(MemoryRow::sampled_torque) = -integral - derivative;
    }
  }

  void forces(const Kinematics& kinematics, ConstPluginState state, Loads& loads) const override {
    add_(law(state), {kinematics.rotors.data(), loads.rotors().data(), kinematics.rotors.size(),
                      kinematics.has_rotations()});
  }

  void laws(ConstPluginState state, ForceLaws& laws) const override {
    laws.motor_torques.push_back(law(state));
    if (!config_.samples && std::isinf(config_.command_timeout)) laws.quiet.push_back({});
  }

 private:
  MotorTorques law(ConstPluginState state) const {
    return {state.data(), config_.kp, limit_.fastest(), config_.sim_slow, places_.data()};
  }

  void warn_if_stiff(const PluginSetup& setup, std::size_t i) const {
    const Joint& joint = setup.model.joints[i];
    const double moment = moment_about_joint(setup.model, i);
    const double decay = (config_.kp + joint.damping) / moment;
    if (decay <= setup.fastest_decay) return;
    std::ostringstream what;
    what << "<kp> is too large for the step: the speed error of joint '" << joint.name
         << "' decays at (kp + damping)/J = " << decay
         << " 1/s, which is unstable in this engine above " << setup.fastest_decay
         << " 1/s. Use <kp> below " << setup.fastest_decay * moment - joint.damping
         << " N m s/rad, or a smaller step.";
    setup.warnings.push_back(what.str());
  }

  Config config_;
  std::size_t rotor_count_;       ///< rotors of the model
  std::vector<double> dampings_;  ///< damping of the joints of config_.rotors [N m s/rad]
  std::vector<int> places_;       ///< MotorTorques::places of each rotor of the model
  void (*add_)(const MotorTorques&, const RotorLanes&);
  std::size_t topic_;
  std::size_t power_;  ///< topic
  SpeedLimit limit_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "rotor speed control: a PID on each joint's velocity (thesis appendix A.4)",
      {
          T::number("kp", "N m s/rad", "", "proportional gain on the slowed-down joint velocity")
              .must()
              .at_least(0)
              .from("A.4")
              .scaling(Effect::lag, -1),
          T::number("ki", "N m/rad", "0", "integral gain; requires iMax and iMin")
              .at_least(0)
              .from("A.4"),
          T::number("kd", "N m s^2/rad", "0", "derivative gain, sampled once per step")
              .at_least(0)
              .from("A.4"),
          T::number("iMax", "N m", "0", "maximum integral torque").at_least(0),
          T::number("iMin", "N m", "0", "minimum integral torque").at_most(0),
          T::number("sim_slow", "", "1", "slowdown: commands are divided by this factor")
              .above(0)
              .from("chapter 4")
              .agreed(),
          SpeedLimit::limit_tag(),
          T::number("commandTimeout", "s", "", "age from which a command counts as 0")
              .above(0)
              .or_absent("off"),
          SpeedLimit::topic_tag(),
          power_tag(),
          T::joints("rotorJoints", "the rotors, in the order of the command"),
      },
      {},
      create<MotorPidPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::motorpid

QUADCORE_REGISTER_PLUGIN(quadcore::motorpid::describe)
