#include <algorithm>
#include <cmath>
#include <sstream>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/counts.hpp"
#include "quadcore/plugin/error.hpp"
#include "shared/rotor_shares.hpp"
#include "shared/speed_limit.hpp"

namespace quadcore::motor {
namespace {

/// Maximum delay in steps.
constexpr double longest_delay = 10000;

/// Motors with a first-order lag and a delayed speed controller. The torque about the joint is J
/// (W* - W)/tau, with different tau for acceleration and deceleration.
class MotorPlugin final : public Plugin {
 public:
  explicit MotorPlugin(const PluginSetup& setup)
      : rotors_(setup.parameters.joints("rotorJoints")),
        up_(setup.parameters.number("timeConstantUp")),
        down_(setup.parameters.number("timeConstantDown")),
        sim_slow_(setup.parameters.number("sim_slow")),
        limit_(setup),
        command_(setup.topics.takes("vel_cmd", messages::speeds(rotors_.size()))),
        power_(setup.topics.takes(setup.parameters.text("power"), shares(rotors_.size()))),
        late_(steps_of(setup.parameters.number("delay"), setup.dt)) {
    for (const std::size_t i : rotors_) moments_.push_back(moment_about_joint(setup.model, i));
    if (1 / std::min(up_, down_) > setup.fastest_decay) {
      std::ostringstream what;
      what << "a time constant is too short for the step: below " << 1 / setup.fastest_decay
           << " s the rotor speed becomes unstable in this engine. Use a longer time constant or a "
              "smaller step.";
      setup.warnings.push_back(what.str());
    }
  }

  /// Whether a command is followed; target [rad/s] and remaining torque fraction of each rotor;
  /// then a ring buffer of the last steps' commands and the number of steps begun.
  std::size_t state_size() const override { return 1 + 2 * rotors_.size() + ring_size() + 1; }

  void describe_rotors(std::vector<RotorDescription>& rotors) const override {
    for (std::size_t j = 0; j < rotors_.size(); ++j) {
      RotorDescription& rotor = rotors[rotors_[j]];
      rotor.rate_per_command = 1 / sim_slow_;
      rotor.lag = std::max(up_, down_);
      rotor.fastest = limit_.fastest();
      rotor.place = static_cast<int>(j);
    }
  }

  void update(const Sample& sample, PluginState state) const override {
    const Topic& power = sample.topics[power_];
    check_shares(power, sample.time);
    const auto n = static_cast<Eigen::Index>(rotors_.size());
    double& steps = state[state.size() - 1];
    const auto slot = [&](double step) {
      const auto index = static_cast<Eigen::Index>(ring_index(step, late_ + 1));
      return state.segment(1 + 2 * n + index * (n + 1), n + 1);
    };
    const Topic& command = sample.topics[command_];
    auto now = slot(steps);
    now[0] = command.count > 0 ? 1 : 0;
    for (Eigen::Index j = 0; j < n; ++j) now[1 + j] = command.values[static_cast<std::size_t>(j)];
    if (command.count > 0) limit_.count(sample, command.values);
    const auto then = slot(steps + 1);  // the oldest command; zeros until the ring is full
    state[0] = then[0];
    for (std::size_t j = 0; j < rotors_.size(); ++j) {
      const auto at = static_cast<Eigen::Index>(j);
      state[1 + at] = limit_.clamped(then[1 + at]) / sim_slow_;
      state[1 + n + at] = power.values[j];
    }
    steps += 1;
  }

  void forces(const Kinematics& kinematics, ConstPluginState state, Loads& loads) const override {
    if (state[0] == 0) return;  // the motors turn freely until the first command
    const auto n = static_cast<Eigen::Index>(rotors_.size());
    for (std::size_t j = 0; j < rotors_.size(); ++j) {
      const auto at = static_cast<Eigen::Index>(j);
      const double target = state[1 + at], share = state[1 + n + at];
      const double rate = kinematics.rotors.number(MotionRow::rate, rotors_[j]);
      const double tau = std::abs(target) > std::abs(rate) ? up_ : down_;
      loads.add_joint_torque(rotors_[j], share * moments_[j] * (target - rate) / tau);
    }
  }

 private:
  static std::size_t steps_of(double delay, double dt) {
    const double steps = std::floor(delay / dt + 0.5);
    if (std::abs(steps * dt - delay) > 1e-6 * dt || steps > longest_delay) {
      std::ostringstream what;
      what << "<delay> " << delay << " is not a whole number of steps of " << dt << " s, at most "
           << longest_delay << ". Use " << std::min(steps, longest_delay) * dt << '.';
      throw InputError(what.str());
    }
    return static_cast<std::size_t>(steps);
  }
  std::size_t ring_size() const { return (late_ + 1) * (rotors_.size() + 1); }

  std::vector<std::size_t> rotors_;
  std::vector<double> moments_;  ///< moments of inertia about the joints' axes [kg m^2]
  double up_, down_;             ///< s
  double sim_slow_;
  SpeedLimit limit_;
  std::size_t command_, power_;  ///< topics
  std::size_t late_;             ///< steps
};

PluginDescriptor describe() {
  using T = TagSpec;
  const std::string rotors = "RotorS";
  return {
      "motors that follow their commands with a first-order lag; replaces the PID",
      {
          T::number("timeConstantUp", "s", "0.0125", "time constant while the rotor accelerates")
              .above(0)
              .from(rotors)
              .scaling(Effect::lag),
          T::number("timeConstantDown", "s", "0.025", "time constant while the rotor decelerates")
              .above(0)
              .from(rotors)
              .scaling(Effect::lag),
          T::number("delay", "s", "0",
                    "delay from a command to the motors, a whole number of steps")
              .at_least(0),
          T::number("sim_slow", "", "1", "slowdown: commands are divided by this factor")
              .above(0)
              .from("chapter 4")
              .agreed(),
          SpeedLimit::limit_tag(),
          SpeedLimit::topic_tag(),
          power_tag(),
          T::joints("rotorJoints", "the rotors, in the order of the command"),
      },
      {},
      create<MotorPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::motor

QUADCORE_REGISTER_PLUGIN(quadcore::motor::describe)
