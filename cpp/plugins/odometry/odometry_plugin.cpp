#include <cmath>
#include <optional>

#include "quadcore/error.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/random.hpp"

namespace quadcore::odometry {
namespace {

struct Config {
  double rate;
  double position_noise, orientation_noise, linear_velocity_noise, angular_velocity_noise;
  bool twist_in_body;

  explicit Config(const Parameters& p)
      : rate(p.number("rate")),
        position_noise(p.number("positionNoise")),
        orientation_noise(p.number("orientationNoise")),
        linear_velocity_noise(p.number("linearVelocityNoise")),
        angular_velocity_noise(p.number("angularVelocityNoise")),
        twist_in_body(p.choice("twistFrame") == "body") {}
};

/// What the sensor remembers: the number of its last message plus one, and how far its noise stream
/// has been drawn.
enum Memory { kMessages, kDraws, kMemorySize };

/// Odometry of the frame (thesis appendix A.6): pose in the world, linear velocity in the world (or
/// in body axes, as nav_msgs/Odometry defines it), angular velocity in body axes, each with white
/// noise of the given standard deviation. Orientation noise is a small rotation about the body
/// axes.
class OdometryPlugin final : public Plugin {
 public:
  explicit OdometryPlugin(const PluginSetup& setup) : config_(setup.parameters) {
    const bool own_seed = setup.parameters.has("seed");
    const double seed = own_seed ? setup.parameters.number("seed") : 0;
    if (seed != std::floor(seed)) throw InputError("<seed> is not a whole number; write one");
    if (own_seed) seed_ = stream_seed(static_cast<std::uint64_t>(seed), setup.name);
    topic_ = setup.topics.publishes(setup.parameters.text("topic"),
                                    messages::kind_of<messages::Odometry>());
    variances_.position_variance = square(config_.position_noise);
    variances_.orientation_variance = square(config_.orientation_noise);
    variances_.linear_velocity_variance = square(config_.linear_velocity_noise);
    variances_.angular_velocity_variance = square(config_.angular_velocity_noise);
  }

  std::size_t state_size() const override { return kMemorySize; }

  void sense(const Sample& sample, PluginState state) const override {
    const double due = std::floor(sample.time * config_.rate + 1e-6) + 1;
    if (due == state[kMessages] && !sample.jumped) return;
    state[kMessages] = due;

    const std::uint64_t seed = seed_.value_or(sample.seed);
    const auto noisy = [&](const Vector3d& v, double deviation) -> Vector3d {
      return deviation == 0 ? v : v + deviation * normal_vector(seed, state[kDraws]);
    };
    const Kinematics& k = sample.kinematics;
    messages::Odometry message = variances_;
    message.position = noisy(k.p_WF, config_.position_noise);
    message.orientation = k.q_WF;
    if (config_.orientation_noise != 0) {
      const Vector3d turn = config_.orientation_noise * normal_vector(seed, state[kDraws]);
      const double angle = turn.norm();
      if (angle > 0) message.orientation = k.q_WF * quaternion_about(turn / angle, angle);
    }
    message.linear_velocity =
        noisy(config_.twist_in_body ? k.v_WF_F : k.R_WF * k.v_WF_F, config_.linear_velocity_noise);
    message.angular_velocity = noisy(k.w_WF_F, config_.angular_velocity_noise);
    sample.topics.publish(topic_, sample.time, message);
  }

 private:
  static Vector3d normal_vector(std::uint64_t seed, double& draws) {
    Vector3d v;
    for (int i = 0; i < 3; ++i) v[i] = random_normal(seed, draws);
    return v;
  }

  static double square(double x) { return x * x; }

  Config config_;
  messages::Odometry variances_;       ///< a message but for what moves
  std::optional<std::uint64_t> seed_;  ///< its own, if it has one
  std::size_t topic_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  const auto deviation = [](const char* name, const char* unit, const char* of) {
    return T::number(name, unit, "0", std::string("standard deviation of the noise on ") + of)
        .at_least(0)
        .from("A.6");
  };
  return {
      "pose and velocity of the frame, with noise (thesis appendix A.6)",
      {
          T::number("rate", "1/s", "1000", "messages per second; at most one per step")
              .above(0)
              .also_called("updateRate")
              .from("A.6"),
          T::text("topic", "odom", "where the messages are published").from("A.6"),
          T::flag("publishTf", "true", "whether a ROS node sends tf world->drone with topic odom")
              .from("A.6"),
          deviation("positionNoise", "m", "each position component"),
          deviation("orientationNoise", "rad", "the rotation about each body axis"),
          deviation("linearVelocityNoise", "m/s", "each linear velocity component"),
          deviation("angularVelocityNoise", "rad/s", "each angular velocity component"),
          T::choice("twistFrame", {"world", "body"},
                    "axes of the linear velocity: world as in the thesis, body as nav_msgs says")
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
