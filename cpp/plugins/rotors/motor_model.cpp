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

/// Quantity that a command sets: speed, angle or torque.
enum class Type { velocity, position, force };
Type type_of(const std::string& name) {
  if (name == "position") return Type::position;
  return name == "force" ? Type::force : Type::velocity;
}

enum Term { kThrust, kRotorDrag, kReaction, kRolling };

/// State: the input, the number of messages read, the speed at the start and end of the step
/// [rad/s], the time of the start [s], the lost fraction of the thrust, the target speed [rad/s] or
/// the torque [N m], and the state of the position controller.
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

/// A rotor and its motor as in RotorS (Furrer, Burri, Achtelik, Siegwart, "RotorS - a modular
/// Gazebo MAV simulator framework", 2016, eqs. (1)-(4); drag and rolling moment after Martin,
/// Salaun, "The true role of accelerometer feedback in quadrotor control", ICRA 2010). The speed
/// follows its command with a first-order lag, and the lag prescribes the joint's rate. The
/// reaction to the rotor's acceleration acts on nothing unless a tag lets it act on the frame.
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
          "' produces no torque: without <cmdMax> and <cmdMin>, Gazebo's PID limits the torque to "
          "0. Write bounds, or <cmdMax>-1</cmdMax> for none.");
    }
    for (const PluginElement& other : setup.model.plugins) {
      if (other.filename != controller_interface_file) continue;
      // Forwarded messages arrive with the next step, as in RotorS.
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
      // The aerodynamic torque, which the motor balances, grows with the square of the speed.
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
    if (!sample.jumped) return;  // after the motion was set, the motor continues from that speed
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
      throw InputError("<jointName> names several joints. Write one motor for each.");
    }
    const std::size_t joint = joints.front();
    const Model& model = setup.model;
    const std::string& link = setup.parameters.text("linkName");
    if (model.links[joint + 1].name != link) {
      throw InputError("<linkName> '" + link + "' is not the child of joint '" +
                       model.joints[joint].name + "'. Write " + model.links[joint + 1].name + ".");
    }
    if (model.joints[joint].parent != 0) {
      throw InputError("joint '" + model.joints[joint].name + "' is attached to the moving link '" +
                       model.links[model.joints[joint].parent].name +
                       "', which this module does not model. Attach it to the frame.");
    }
    return joint;
  }

  static std::size_t number_of(const PluginSetup& setup) {
    const double number = setup.parameters.number("motorNumber");
    const auto motors = static_cast<double>(motor_count(setup.model));
    if (number != std::floor(number) || number >= motors) {
      throw InputError("<motorNumber> " + setup.parameters.text("motorNumber") +
                       " is not a valid motor number: the model has " +
                       std::to_string(motor_count(setup.model)) +
                       " motors, counted from 0. Number them without gaps. To stop a motor, use "
                       "libfault_plugin.so.");
    }
    return static_cast<std::size_t>(number);
  }

  static std::optional<std::size_t> speed_topic(const PluginSetup& setup) {
    if (!setup.parameters.has("motorSpeedPubTopic")) return std::nullopt;
    return setup.topics.publishes(topic_of(setup, "motorSpeedPubTopic"), messages::motor_speed());
  }

  bool turns() const { return type_ == Type::velocity; }

  /// The latest message counts, whether it is for the motors or comes through the controller
  /// interface.
  void listen(const Sample& sample, PluginState state) const {
    const auto hear = [&](std::size_t topic, Memory heard) {
      const Topic& message = sample.topics[topic];
      if (message.count == state[heard]) return;
      state[heard] = message.count;
      // RotorS' messages have single precision.
      const double input = static_cast<float>(message.values[number_]);
      state[kInput] = turns() ? std::min(input, fastest_) : input;
    };
    if (forwarded_) hear(*forwarded_, kForwarded);
    hear(command_, kDirect);
  }

  std::size_t joint_;
  Type type_;
  double sense_;  ///< direction of a positive command about the joint's axis, 1 or -1
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
  std::optional<std::size_t> forwarded_;  ///< topic of the controller interface, if there is one
  std::optional<std::size_t> speed_;      ///< topic
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<TagSpec> tags = {
      T::joints("jointName", "joint that the motor turns").must(),
      T::text("linkName", "", "child link of the joint").must(),
      T::choice("turningDirection", {"ccw", "cw"},
                "direction about the joint's axis in which a positive command turns the rotor")
          .must(),
      T::number("motorNumber", "", "", "index in the command, counted from 0").must().at_least(0),
      T::choice("motorType", {"velocity", "position", "force"},
                "quantity that the command sets: speed, rad/s; angle, rad; torque, N m"),
      T::number("motorConstant", "N s^2/rad^2", "8.54858e-06", "thrust per squared speed")
          .at_least(0)
          .scaling(Effect::thrust),
      T::number("momentConstant", "m", "0.016", "reaction torque divided by thrust"),
      T::number("rotorDragCoefficient", "N s^2/(rad m)", "1e-4",
                "drag divided by the rotor speed and the link origin's velocity perpendicular to "
                "the axis")
          .at_least(0)
          .scaling(Effect::drag),
      T::number("rollingMomentCoefficient", "N s^2/rad", "1e-6",
                "rolling moment on the frame, divided by the rotor speed and the same velocity")
          .at_least(0)
          .scaling(Effect::drag),
      T::number("maxRotVelocity", "rad/s", "838", "maximum speed that the motor follows").above(0),
      T::number("timeConstantUp", "s", "0.0125", "time constant of the lag while the speed rises")
          .above(0)
          .scaling(Effect::lag),
      T::number("timeConstantDown", "s", "0.025", "time constant of the lag while the speed falls")
          .above(0)
          .scaling(Effect::lag),
      T::number("rotorVelocitySlowdownSim", "", "10",
                "factor by which the joint turns slower than the rotor")
          .above(0),
      T::flag("reactionTorque", "false",
              "quadcore extension: whether the frame takes the reaction to the rotor's "
              "acceleration; RotorS omits it"),
      T::text("effectiveness", "effectiveness",
              "quadcore extension: topic with the remaining fraction of each joint's thrust and "
              "reaction torque; 1 before the first message"),
      T::text("power", "power",
              "quadcore extension: topic with the remaining fraction of each motor's torque, 0 to "
              "1, which scales the square of the commanded speed; 1 before the first message"),
      T::text("commandSubTopic", "gazebo/command/motor_speed",
              "topic on which the controller interface forwards commands, if the model has one; "
              "otherwise commands arrive only on vel_cmd"),
      T::text("motorSpeedPubTopic", "", "topic of the joint's rate").or_absent("not published"),
      idle("motorPositionPubTopic", "the log and the state contain the angles"),
      idle("motorForcePubTopic", "the wrenches contain the forces"),
      idle("windSpeedSubTopic", "the wind plugins set the air velocity directly"),
      namespace_tag(),
  };
  for (TagSpec& tag : tags) {
    if (tag.equation.empty()) tag.equation = "RotorS";
  }
  PositionControl::add_tags(tags);
  return {
      "RotorS' motor and rotor: first-order lag of the speed, thrust, drag, reaction torque and "
      "rolling moment",
      tags,
      {"thrust", "rotor_drag", "reaction", "rolling"},
      create<MotorModel>,
      true,
  };
}

}  // namespace
}  // namespace quadcore::rotors

QUADCORE_REGISTER_PLUGIN(quadcore::rotors::describe)
