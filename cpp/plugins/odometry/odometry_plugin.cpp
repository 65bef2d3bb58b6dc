#include <cmath>
#include <optional>

#include "quadcore/force_laws.hpp"
#include "quadcore/law_interface.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/error.hpp"
#include "shared/mounted_sensor.hpp"

namespace quadcore::odometry {
namespace {

/// State: time of measurement, number of random numbers drawn, and the biases of position,
/// orientation and velocities.
enum Memory { kTime, kDraws, kBiases, kMemorySize = kBiases + OdometryErrors::biases };

/// Odometry of the frame (thesis appendix A.6): pose in the world, linear velocity in world axes
/// (or in body axes, as nav_msgs/Odometry defines it), and angular velocity in body axes, each with
/// errors. The errors of the orientation are small rotations about the body axes.
class OdometryPlugin final : public sensing::MountedSensor<messages::Odometry, kMemorySize> {
 public:
  static constexpr const char* law_interface = quadcore::law_interface;

  explicit OdometryPlugin(const PluginSetup& setup)
      : MountedSensor(setup),
        errors_{read_errors(setup.parameters, "position", true),
                read_errors(setup.parameters, "orientation", false),
                read_errors(setup.parameters, "linearVelocity", true),
                read_errors(setup.parameters, "angularVelocity", true)},
        twist_in_body_(setup.parameters.choice("twistFrame") == "body"),
        measures_each_step_(setup.parameters.number("rate") * setup.dt >= 1),
        is_perfect_(errors_.is_none() && channel().is_direct()) {
    const bool own_seed = setup.parameters.has("seed");
    const double seed = own_seed ? setup.parameters.number("seed") : 0;
    if (seed != std::floor(seed))
      throw InputError("<seed> is not a whole number. Write a whole number.");
    if (own_seed) seed_ = stream_seed(static_cast<std::uint64_t>(seed), setup.name);
    variances_.position_variance = errors_.position.variance();
    variances_.orientation_variance = errors_.orientation.variance();
    variances_.linear_velocity_variance = errors_.linear_velocity.variance();
    variances_.angular_velocity_variance = errors_.angular_velocity.variance();
  }

  void sense(const Sample& sample, PluginState state) const override {
    if (is_perfect_) {
      if (!is_due(sample, state)) return;
      return sample.topics.publish(channel().topic(), sample.time, truth(sample.kinematics));
    }
    if (!seed_) return MountedSensor::sense(sample, state);
    Sample seeded = sample;
    seeded.seed = *seed_;
    MountedSensor::sense(seeded, state);
  }

  void laws(ConstPluginState, ForceLaws& laws) const override {
    const bool is_simple = measures_each_step_ && channel().is_direct() &&
                           errors_.are_independent() && !twist_in_body_;
    laws.odometry.push_back({channel().topic(), errors_, is_simple, seed_});
  }

 private:
  /// Return the true odometry. It is initialised, because assigned vectors would be stored by
  /// single numbers and stall when they are read in pairs.
  messages::Odometry truth(const Kinematics& k) const {
    return {k.p_WF,
            k.q_WF,
            twist_in_body_ ? k.v_WF_F : k.R_WF * k.v_WF_F,
            k.w_WF_F,
            variances_.position_variance,
            variances_.orientation_variance,
            variances_.linear_velocity_variance,
            variances_.angular_velocity_variance};
  }

  static VectorErrors read_errors(const Parameters& p, const std::string& quantity,
                                  bool has_resolution) {
    return {p.number(quantity + "Noise"), p.number(quantity + "Walk"),
            has_resolution ? p.number(quantity + "Resolution") : 0};
  }

  std::optional<messages::Odometry> measure(const Sample& sample,
                                            PluginState memory) const override {
    std::optional<messages::Odometry> message = truth(sample.kinematics);
    const double since = sample.jumped ? 0 : sample.time - memory[kTime];
    memory[kTime] = sample.time;
    errors_.apply(*message, since, sample.seed, memory[kDraws], &memory[kBiases]);
    return message;
  }

  OdometryErrors errors_;
  bool twist_in_body_;
  bool measures_each_step_;
  bool is_perfect_;                    ///< messages are exact and arrive at once
  messages::Odometry variances_;       ///< a message that contains only the variances
  std::optional<std::uint64_t> seed_;  ///< its own seed, if any
};

PluginDescriptor describe() {
  using T = TagSpec;
  const auto deviation = [](const char* name, const char* unit, const char* of) {
    return T::number(name, unit, "0", std::string("standard deviation of the noise on ") + of)
        .at_least(0)
        .from("A.6");
  };
  const auto walk = [](const char* name, const char* unit, const char* of) {
    return T::number(name, unit, "0",
                     std::string("random walk of the bias of ") + of +
                         ": standard deviation after 1 s; it grows with sqrt(t)")
        .at_least(0);
  };
  const auto resolution = [](const char* name, const char* unit, const char* of) {
    return T::number(name, unit, "0",
                     "quantisation step of " + std::string(of) +
                         "; 0: none; adds step^2/12 to the variance")
        .at_least(0);
  };
  const char *position = "each position component", *turn = "the rotation about each body axis",
             *linear = "each linear velocity component",
             *angular = "each angular velocity component";
  return {
      "odometry: pose and velocity of the frame, with noise (thesis appendix A.6)",
      {
          T::number("rate", "1/s", "1000", "messages per second; at most one per step")
              .above(0)
              .also_called("updateRate")
              .from("A.6"),
          T::text("topic", "odom", "topic of the messages").from("A.6"),
          T::flag("publishTf", "true",
                  "whether the ROS node publishes tf world->drone for topic odom")
              .from("A.6"),
          T::text("frame_id", "", "frame of the pose in messages of the ROS node")
              .or_absent("the node's world_frame"),
          T::text("child_frame_id", "", "frame of the vehicle in messages of the ROS node")
              .or_absent("the node's vehicle_frame"),
          deviation("positionNoise", "m", position),
          deviation("orientationNoise", "rad", turn),
          deviation("linearVelocityNoise", "m/s", linear),
          deviation("angularVelocityNoise", "rad/s", angular),
          walk("positionWalk", "m/sqrt(s)", position),
          walk("orientationWalk", "rad/sqrt(s)", turn),
          walk("linearVelocityWalk", "m/s/sqrt(s)", linear),
          walk("angularVelocityWalk", "rad/s/sqrt(s)", angular),
          resolution("positionResolution", "m", position),
          resolution("linearVelocityResolution", "m/s", linear),
          resolution("angularVelocityResolution", "rad/s", angular),
          sensing::Channel::delay_tag(),
          sensing::Channel::dropout_tag(),
          T::choice("twistFrame", {"world", "body"},
                    "axes of the linear velocity: world as in the thesis, body as nav_msgs defines")
              .agreed()
              .from("A.6"),
          T::number("seed", "", "", "seed of the noise, a whole number")
              .at_least(0)
              .at_most(9007199254740992.0)
              .or_absent("the simulation's seed"),
      },
      {},
      create<OdometryPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::odometry

QUADCORE_REGISTER_PLUGIN(quadcore::odometry::describe)
