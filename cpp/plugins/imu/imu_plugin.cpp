#include "quadcore/plugin.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "shared/sensing.hpp"
#include "triad.hpp"

namespace quadcore::imu {
namespace {

/// What it remembers: when it measured, whether it is turned on, time, velocity (world axes) and
/// orientation then, how far its random numbers are drawn, the errors, what is on the way.
enum Memory {
  kSamples,
  kOn,
  kTime,
  kVelocity,
  kOrientation = kVelocity + 3,
  kDraws = kOrientation + 4,
  kGyroscope,
  kAccelerometer = kGyroscope + Triad::kMemorySize,
  kChannel = kAccelerometer + Triad::kMemorySize
};

/// Angular velocity and specific force of a link of the frame, in the link's axes: the mean over
/// the time since the last sample, as a unit that integrates its rates tells them.
class ImuPlugin final : public Plugin {
 public:
  explicit ImuPlugin(const PluginSetup& setup)
      : X_FS_(setup.model.pose_of_link.at(setup.parameters.choice("link"))),
        q_FS_(X_FS_.rotation()),
        rate_(setup.parameters.number("rate")),
        gyroscope_(setup.parameters, "gyro"),
        accelerometer_(setup.parameters, "accelerometer"),
        channel_(setup,
                 setup.topics.publishes(setup.parameters.text("topic"),
                                        messages::kind_of<messages::Imu>()),
                 messages::kind_of<messages::Imu>(), setup.parameters.number("rate")) {}

  std::size_t state_size() const override { return kChannel + channel_.state_size(); }

  void sense(const Sample& sample, PluginState state) const override {
    PluginState on_the_way(state.data() + kChannel, state.size() - kChannel);
    if (state[kOn] == 0) {
      state[kOn] = 1;
      gyroscope_.begin(sample.seed, state[kDraws], errors(state, kGyroscope));
      accelerometer_.begin(sample.seed, state[kDraws], errors(state, kAccelerometer));
    }
    if (rate_.is_due(sample, state[kSamples])) {
      const Kinematics& k = sample.kinematics;
      const Vector3d v_WS_W = k.v_WS_W(X_FS_.xyz);
      const Quaterniond q_WS = k.q_WF * q_FS_;
      // What was set was not measured: there is no time to take the mean over.
      if (sample.jumped) {
        channel_.clear(on_the_way);
      } else {
        channel_.send(sample, sample.seed, on_the_way, measured(sample, v_WS_W, q_WS, state));
      }
      state[kTime] = sample.time;
      state.segment<3>(kVelocity) = v_WS_W;
      state.segment<4>(kOrientation) = q_WS.coeffs();
    }
    channel_.deliver(sample, on_the_way);
  }

 private:
  static Eigen::Map<VectorXd> errors(PluginState& state, Eigen::Index begin) {
    return {state.data() + begin, Triad::kMemorySize};
  }

  messages::Imu measured(const Sample& sample, const Vector3d& v_WS_W, const Quaterniond& q_WS,
                         PluginState state) const {
    const double period = sample.time - state[kTime];
    const Quaterniond q_WSlast(state.data() + kOrientation);
    const Vector3d f_W = (v_WS_W - state.segment<3>(kVelocity)) / period - sample.world.gravity_W;
    const Vector3d turn_S = turn(q_WSlast.conjugate() * q_WS);
    messages::Imu message;
    message.angular_velocity = gyroscope_.apply(turn_S / period, period, sample.seed, state[kDraws],
                                                errors(state, kGyroscope));
    message.specific_force =
        accelerometer_.apply(of_turning_axes(turn_S, q_WSlast.conjugate() * f_W), period,
                             sample.seed, state[kDraws], errors(state, kAccelerometer));
    message.angular_velocity_variance = gyroscope_.variance(period);
    message.specific_force_variance = accelerometer_.variance(period);
    return message;
  }

  /// The vector that, constant in axes that turn steadily, has a mean in those axes where they
  /// stood at the beginning: the inverse of the integral of the rotation, the left Jacobian of
  /// SO(3) (T. D. Barfoot, "State Estimation for Robotics", 2017, eq. (7.76b)).
  static Vector3d of_turning_axes(const Vector3d& turn, const Vector3d& mean) {
    const double square = turn.squaredNorm();
    double factor = 1.0 / 12 + square * (1.0 / 720 + square / 30240);
    if (square > 1e-2) {
      const elementary::SineCosine half = elementary::sincos(std::sqrt(square) / 2);
      factor = (1 - std::sqrt(square) / 2 * half.cos / half.sin) / square;
    }
    return mean - turn.cross(mean) / 2 + factor * turn.cross(turn.cross(mean));
  }

  /// Axis times angle, at most pi, of a rotation.
  static Vector3d turn(const Quaterniond& q) {
    const double sine = q.vec().norm();
    if (sine == 0) return Vector3d::Zero();
    const double sign = q.w() < 0 ? -1 : 1;
    return sign * 2 * elementary::atan2(sine, sign * q.w()) / sine * q.vec();
  }

  Pose X_FS_;         ///< of the link in the frame
  Quaterniond q_FS_;  ///< the same turn
  sensing::Rate rate_;
  Triad gyroscope_, accelerometer_;
  sensing::Channel channel_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<TagSpec> tags = {
      T::link("link", "where it is mounted; its axes are the unit's"),
      T::number("rate", "1/s", "200", "samples per second; at most one per step").above(0),
      T::text("topic", "imu", "where the messages are published"),
  };
  Triad::add_tags(tags, "gyro", "the angular velocity", "rad/s");
  Triad::add_tags(tags, "accelerometer", "the specific force", "m/s^2");
  tags.push_back(sensing::Channel::delay_tag());
  tags.push_back(sensing::Channel::dropout_tag());
  return {
      "an inertial measurement unit on a link of the frame; in gazebo11 and ode it measures the "
      "rate at the end of each step, with which the step turns the vehicle",
      tags,
      {},
      create<ImuPlugin>};
}

}  // namespace
}  // namespace quadcore::imu

QUADCORE_REGISTER_PLUGIN(quadcore::imu::describe)
