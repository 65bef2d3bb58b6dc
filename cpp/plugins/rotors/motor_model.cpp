#include <cmath>
#include <limits>
#include <optional>

#include "lag.hpp"
#include "naming.hpp"
#include "position_control.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/rotor_shares.hpp"
#include "twins.hpp"

namespace quadcore::rotors {
namespace {

/// What a command is: a speed, an angle, or a torque.
enum class Type { velocity, position, force };
Type type_of(const std::string& name) {
  if (name == "position") return Type::position;
  return name == "force" ? Type::force : Type::velocity;
}

enum Term { kThrust, kRotorDrag, kReaction, kRolling };

/// What it remembers: its input, the messages that it has heard, the speed at the start of the step
/// and at its end [rad/s], the time of the start [s], the share of the thrust that is lost, the
/// speed that it is driven to [rad/s] or its torque [N m], and what the position's controller
/// holds.
enum Memory {
  kInput,
  kDirect,
  kForwarded,
  kSpeed,
  kNext,
  kTime,
  kLost,
  kDriven,
  kTorque,
  kControl
};

/// A rotor and its motor as RotorS has them (Furrer, Burri, Achtelik, Siegwart, "RotorS - a modular
/// Gazebo MAV simulator framework", 2016, eqs. (1)-(4); drag and rolling moment after Martin,
/// Salaun, "The true role of accelerometer feedback in quadrotor control", ICRA 2010). The speed
/// follows its command with a lag of first order, and the joint turns as the lag says: what the
/// rotor's moment of inertia takes comes from nowhere, unless a tag lets it act on the frame.
class MotorModel final : public Plugin {
 public:
  explicit MotorModel(const PluginSetup& setup)
      : joint_(joint_of(setup)),
        type_(type_of(setup.parameters.choice("motorType"))),
        sense_(setup.parameters.choice("turningDirection") == "ccw" ? 1 : -1),
        number_(number_of(setup)),
        fastest_(setup.parameters.number("maxRotVelocity")),
        motor_constant_(setup.parameters.number("motorConstant")),
        moment_constant_(setup.parameters.number("momentConstant")),
        drag_(setup.parameters.number("rotorDragCoefficient")),
        rolling_(setup.parameters.number("rollingMomentCoefficient")),
        slowdown_(setup.parameters.number("rotorVelocitySlowdownSim")),
        lag_{setup.parameters.number("timeConstantUp"),
             setup.parameters.number("timeConstantDown")},
        reacts_(setup.parameters.flag("reactionTorque")),
        control_(setup.parameters),
        command_(setup.topics.takes("vel_cmd", messages::speeds(motor_count(setup.model)))),
        effectiveness_(setup.topics.takes(setup.parameters.text("effectiveness"),
                                          shares(setup.model.joints.size()))),
        power_(
            setup.topics.takes(setup.parameters.text("power"), shares(setup.model.joints.size()))),
        speed_(speed_topic(setup)) {
    look_at_twins(setup);
    if (type_ == Type::position && control_.is_mute()) {
      setup.warnings.push_back(
          "motor '" + setup.name +
          "' holds no angle: without <cmdMax> and <cmdMin> Gazebo's PID lets no "
          "torque through; write bounds, or <cmdMax>-1</cmdMax> for none");
    }
    for (const PluginElement& other : setup.model.plugins) {
      if (other.filename != controller_interface_file) continue;
      // As RotorS' own messages do, what it forwards arrives with the next step.
      forwarded_ = setup.topics.takes(topic_of(setup, "commandSubTopic"),
                                      messages::speeds(motor_count(setup.model)), true);
      break;
    }
  }

  std::size_t state_size() const override { return kControl + PositionControl::kMemorySize; }

  void describe_rotors(std::vector<RotorDescription>& rotors) const override {
    RotorDescription& rotor = rotors[joint_];
    rotor.otherwise = !turns();
    if (rotor.otherwise) return;
    rotor.slowdown = slowdown_;
    rotor.rate_per_command = sense_ / slowdown_;
    rotor.lag = std::max(lag_.up, lag_.down);
    rotor.fastest = fastest_;
    rotor.place = static_cast<int>(number_);
    rotor.spin = sense_;
    rotor.prescribed = true;
  }

  void update(const Sample& sample, PluginState state) const override {
    listen(sample, state);
    const Topic &effectiveness = sample.topics[effectiveness_], &power = sample.topics[power_];
    check_shares(effectiveness, sample.time);
    check_shares(power, sample.time);
    state[kLost] = 1 - effectiveness.values[joint_];
    const double input = state[kInput], left = power.values[joint_];
    if (type_ == Type::force) {
      state[kTorque] = left * input;
    } else if (type_ == Type::position) {
      state[kTorque] =
          left * control_.torque(sample.kinematics.angle(joint_), input, sample.dt,
                                 state.segment<PositionControl::kMemorySize>(kControl));
    } else {
      // The air's torque, which the motor's balances, grows with the square of the speed.
      state[kDriven] = std::sqrt(left) * input;
      state[kSpeed] = state[kNext];
      state[kNext] = lag_.after(sample.dt, state[kSpeed], state[kDriven]);
      state[kTime] = sample.time;
    }
    if (!speed_) return;
    *sample.topics.publish(*speed_, sample.time) =
        turns() ? sense_ * state[kNext] / slowdown_
                : sample.kinematics.rotors.number(MotionRow::rate, joint_);
  }

  void sense(const Sample& sample, PluginState state) const override {
    if (!sample.jumped) return;  // the motor goes on from a speed that was set
    state[kNext] = sense_ * sample.kinematics.rotors.number(MotionRow::rate, joint_) * slowdown_;
  }

  void forces(const Kinematics& k, ConstPluginState state, Loads& loads) const override {
    if (!turns()) return loads.add_joint_torque(joint_, state[kTorque]);
    const RotorKinematics rotor = k.rotors[joint_];
    const double speed = rotor.rate * slowdown_;
    const double thrust =
        (1 - state[kLost]) * sense_ * std::copysign(motor_constant_ * speed * speed, speed);
    loads.add_rotor_force(kThrust, joint_, thrust * rotor.normal_F);
    const Vector3d v_AR_F = rotor.v_WR_F - k.v_WA_F;
    const Vector3d across_F = v_AR_F - v_AR_F.dot(rotor.axis_F) * rotor.axis_F;
    loads.add_rotor_force(kRotorDrag, joint_, -std::abs(speed) * drag_ * across_F);
    loads.add_frame_torque(kReaction, -sense_ * thrust * moment_constant_ * rotor.normal_F);
    loads.add_frame_torque(kRolling, -std::abs(speed) * rolling_ * across_F);

    const double slope = lag_.slope(k.time - state[kTime], state[kSpeed], state[kDriven]);
    const double unit = sense_ / slowdown_;
    loads.prescribe_joint_rate(joint_, {unit * state[kNext], unit * slope, reacts_});
  }

 private:
  static std::size_t joint_of(const PluginSetup& setup) {
    const std::vector<std::size_t>& joints = setup.parameters.joints("jointName");
    if (joints.size() != 1) {
      throw InputError("<jointName> names several joints; write one motor for each");
    }
    const std::size_t joint = joints.front();
    const Model& model = setup.model;
    const std::string& link = setup.parameters.text("linkName");
    if (model.links[joint + 1].name != link) {
      throw InputError("<linkName> '" + link + "' is not what joint '" + model.joints[joint].name +
                       "' turns; write " + model.links[joint + 1].name);
    }
    if (model.joints[joint].parent != 0) {
      throw InputError("joint '" + model.joints[joint].name + "' hangs on the moving link '" +
                       model.links[model.joints[joint].parent].name +
                       "', which this module does not model; let the frame carry it");
    }
    return joint;
  }

  static std::size_t number_of(const PluginSetup& setup) {
    const double number = setup.parameters.number("motorNumber");
    const auto motors = static_cast<double>(motor_count(setup.model));
    if (number != std::floor(number) || number >= motors) {
      throw InputError(
          "<motorNumber> " + setup.parameters.text("motorNumber") +
          " is no number of a motor; the model has " + std::to_string(motor_count(setup.model)) +
          ", counted from 0; number them without a gap, and cut one that is to stand still "
          "with libfault_plugin.so");
    }
    return static_cast<std::size_t>(number);
  }

  static std::optional<std::size_t> speed_topic(const PluginSetup& setup) {
    if (!setup.parameters.has("motorSpeedPubTopic")) return std::nullopt;
    return setup.topics.publishes(topic_of(setup, "motorSpeedPubTopic"), messages::motor_speed());
  }

  bool turns() const { return type_ == Type::velocity; }

  /// What came last counts, be it for the motors directly or by way of the controller's interface.
  void listen(const Sample& sample, PluginState state) const {
    const auto hear = [&](std::size_t topic, Memory heard) {
      const Topic& message = sample.topics[topic];
      if (message.count == state[heard]) return;
      state[heard] = message.count;
      // Messages of RotorS carry single precision.
      const double input = static_cast<float>(message.values[number_]);
      state[kInput] = turns() ? std::min(input, fastest_) : input;
    };
    if (forwarded_) hear(*forwarded_, kForwarded);
    hear(command_, kDirect);
  }

  std::size_t joint_;
  Type type_;
  double sense_;  ///< 1 or -1: of a positive command about the joint's axis
  std::size_t number_;
  double fastest_;                           ///< rad/s
  double motor_constant_, moment_constant_;  ///< N s^2/rad^2, m
  double drag_, rolling_;                    ///< N s^2/(rad m), N s^2/rad
  double slowdown_;
  Lag lag_;
  bool reacts_;
  PositionControl control_;
  std::size_t command_;                   ///< topic
  std::size_t effectiveness_, power_;     ///< topics
  std::optional<std::size_t> forwarded_;  ///< of the controller's interface, if there is one
  std::optional<std::size_t> speed_;      ///< topic
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<TagSpec> tags = {
      T::joints("jointName", "the joint that it turns").must(),
      T::text("linkName", "", "the link on that joint").must(),
      T::choice("turningDirection", {"ccw", "cw"},
                "sense about the joint's axis in which a positive command turns it")
          .must(),
      T::number("motorNumber", "", "", "its place in a command, from 0 on").must().at_least(0),
      T::choice("motorType", {"velocity", "position", "force"},
                "what a command is: a speed, rad/s; an angle, rad; a torque, N m"),
      T::number("motorConstant", "N s^2/rad^2", "8.54858e-06",
                "thrust is this times the square of "
                "the speed")
          .at_least(0)
          .scaling(Effect::thrust),
      T::number("momentConstant", "m", "0.016", "reaction torque by thrust"),
      T::number(
          "rotorDragCoefficient", "N s^2/(rad m)", "1e-4",
          "drag is this times the speed and the velocity of the link's origin across the axis")
          .at_least(0)
          .scaling(Effect::drag),
      T::number("rollingMomentCoefficient", "N s^2/rad", "1e-6",
                "the like torque on the frame, along that velocity")
          .at_least(0)
          .scaling(Effect::drag),
      T::number("maxRotVelocity", "rad/s", "838", "fastest command that is followed").above(0),
      T::number("timeConstantUp", "s", "0.0125", "of the lag while the speed rises")
          .above(0)
          .scaling(Effect::lag),
      T::number("timeConstantDown", "s", "0.025", "of the lag while it falls")
          .above(0)
          .scaling(Effect::lag),
      T::number("rotorVelocitySlowdownSim", "", "10", "the joint turns slower by this factor")
          .above(0),
      T::flag("reactionTorque", "false",
              "quadcore's own: whether the frame bears the torque that speeds the rotor up; not so "
              "in RotorS"),
      T::text("effectiveness", "effectiveness",
              "quadcore's own: topic of each joint's share of thrust and reaction torque that is "
              "left; 1 before the first message"),
      T::text(
          "power", "power",
          "quadcore's own: topic of each joint's share of the motor's torque that is left, 0 to "
          "1; it reaches that share of the commanded speed's square; 1 before the first message"),
      T::text("commandSubTopic", "gazebo/command/motor_speed",
              "where the controller's interface forwards commands, if the model has one; else "
              "commands come on vel_cmd alone"),
      T::text("motorSpeedPubTopic", "", "where the joint's rate is published")
          .or_absent("not published"),
      idle("motorPositionPubTopic", "the log and the state hold the angles"),
      idle("motorForcePubTopic", "wrenches hold the forces"),
      idle("windSpeedSubTopic", "the air is what the wind module and all others make it"),
      namespace_tag(),
  };
  for (TagSpec& tag : tags) {
    if (tag.equation.empty()) tag.equation = "RotorS";
  }
  PositionControl::add_tags(tags);
  return {
      "RotorS' motor and rotor: a speed that lags, thrust, drag, reaction and rolling moment",
      tags,
      {"thrust", "rotor_drag", "reaction", "rolling"},
      create<MotorModel>,
      true,
  };
}

}  // namespace
}  // namespace quadcore::rotors

QUADCORE_REGISTER_PLUGIN(quadcore::rotors::describe)
