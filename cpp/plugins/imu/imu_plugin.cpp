#include "quadcore/plugin.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "shared/mounted_sensor.hpp"
#include "triad.hpp"

namespace quadcore::imu {
namespace {

/// State: whether it is turned on; time, velocity (world axes) and orientation of the last sample;
/// the number of random numbers drawn; the errors.
enum Memory {
  kOn,
  kTime,
  kVelocity,
  kOrientation = kVelocity + 3,
  kDraws = kOrientation + 4,
  kGyroscope,
  kAccelerometer = kGyroscope + Triad::kMemorySize,
  kMemorySize = kAccelerometer + Triad::kMemorySize
};

/// Angular velocity and specific force of a link of the frame, in the link's axes: the means over
/// the time since the last sample, as reported by a sensor that integrates its rates.
class ImuPlugin final : public sensing::MountedSensor<messages::Imu, kMemorySize> {
 public:
  explicit ImuPlugin(const PluginSetup& setup)
      : MountedSensor(setup),
        X_FS_(mounting(setup)),
        q_FS_(X_FS_.rotation()),
        gyroscope_(setup.parameters, "gyro"),
        accelerometer_(setup.parameters, "accelerometer") {}

 private:
  std::optional<messages::Imu> measure(const Sample& sample, PluginState memory) const override {
    if (memory[kOn] == 0) {
      memory[kOn] = 1;
      gyroscope_.begin(sample.seed, memory[kDraws], errors(memory, kGyroscope));
      accelerometer_.begin(sample.seed, memory[kDraws], errors(memory, kAccelerometer));
    }
    const Vector3d v_WS_W = sample.kinematics.v_WS_W(X_FS_.xyz);
    const Quaterniond q_WS = sample.kinematics.q_WF * q_FS_;
    // There is no interval to average over after the motion was set.
    std::optional<messages::Imu> message;
    if (!sample.jumped) message = mean(sample, v_WS_W, q_WS, memory);
    memory[kTime] = sample.time;
    memory.segment<3>(kVelocity) = v_WS_W;
    memory.segment<4>(kOrientation) = q_WS.coeffs();
    return message;
  }

  static PluginState errors(PluginState& memory, Eigen::Index begin) {
    return {memory.data() + begin, Triad::kMemorySize};
  }

  /// Return the measurement over the time since the last sample.
  messages::Imu mean(const Sample& sample, const Vector3d& v_WS_W, const Quaterniond& q_WS,
                     PluginState memory) const {
    const double period = sample.time - memory[kTime];
    const Quaterniond q_WSlast(memory.data() + kOrientation);
    const Vector3d f_W = (v_WS_W - memory.segment<3>(kVelocity)) / period - sample.world.gravity_W;
    const Vector3d turn_S = turn(q_WSlast.conjugate() * q_WS);
    messages::Imu message;
    message.angular_velocity = gyroscope_.apply(turn_S / period, period, sample.seed,
                                                memory[kDraws], errors(memory, kGyroscope));
    message.specific_force =
        accelerometer_.apply(of_turning_axes(turn_S, q_WSlast.conjugate() * f_W), period,
                             sample.seed, memory[kDraws], errors(memory, kAccelerometer));
    message.angular_velocity_variance = gyroscope_.variance(period);
    message.specific_force_variance = accelerometer_.variance(period);
    return message;
  }

  /// Return the vector that is constant in steadily rotating axes and has a given mean in the
  /// initial axes: the inverse of the integral of the rotation, the left Jacobian of SO(3) (T. D.
  /// Barfoot, "State Estimation for Robotics", 2017, eq. (7.76b)).
  static Vector3d of_turning_axes(const Vector3d& turn, const Vector3d& mean) {
    const double square = turn.squaredNorm();
    double factor = 1.0 / 12 + square * (1.0 / 720 + square / 30240);
    if (square > 1e-2) {
      const elementary::SineCosine half = elementary::sincos(std::sqrt(square) / 2);
      factor = (1 - std::sqrt(square) / 2 * half.cos / half.sin) / square;
    }
    return mean - turn.cross(mean) / 2 + factor * turn.cross(turn.cross(mean));
  }

  /// Return axis times angle of a rotation, with an angle of at most pi.
  static Vector3d turn(const Quaterniond& q) {
    const double sine = q.vec().norm();
    if (sine == 0) return Vector3d::Zero();
    const double sign = q.w() < 0 ? -1 : 1;
    return sign * 2 * elementary::atan2(sine, sign * q.w()) / sine * q.vec();
  }

  Pose X_FS_;         ///< pose of the link in the frame
  Quaterniond q_FS_;  ///< orientation of the link in the frame
  Triad gyroscope_, accelerometer_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<TagSpec> tags = {
      T::link("link", "link that carries the sensor; its axes are the sensor's axes"),
      T::number("rate", "1/s", "200", "samples per second; at most one per step").above(0),
      T::text("topic", "imu", "topic of the messages"),
  };
  Triad::add_tags(tags, "gyro", "the angular velocity", "rad/s");
  Triad::add_tags(tags, "accelerometer", "the specific force", "m/s^2");
  tags.push_back(sensing::Channel::delay_tag());
  tags.push_back(sensing::Channel::dropout_tag());
  return {
      "inertial measurement unit on a link of the frame. In gazebo11 and ode it measures the "
      "angular velocity at the end of each step, with which that step rotates the vehicle",
      tags,
      {},
      create<ImuPlugin>};
}

}  // namespace
}  // namespace quadcore::imu

QUADCORE_REGISTER_PLUGIN(quadcore::imu::describe)
