#include <cmath>

#include "center_of_mass.hpp"
#include "naming.hpp"
#include "noise.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/counts.hpp"

namespace quadcore::rotors {
namespace {

/// State: number of steps and of random numbers drawn; then a ring buffer of pending messages.
enum Memory { kSteps, kDraws, kRing };

/// Pose of a link's centre of mass in the world and velocity of its origin in link axes, at the
/// start of a step.
class Odometry final : public Plugin {
 public:
  explicit Odometry(const PluginSetup& setup)
      : X_FS_(place_of(setup, "linkName")),
        p_SScm_S_(center_of_mass(setup.model, setup.parameters.text("linkName"))),
        divisor_(setup.parameters.number("measurementDivisor")),
        delay_(setup.parameters.number("measurementDelay")),
        unknown_delay_(std::trunc(setup.parameters.number("unknownDelay"))),
        own_seed_(setup.parameters.has("randomEngineSeed")),
        seed_(own_seed_ ? static_cast<std::uint64_t>(setup.parameters.number("randomEngineSeed"))
                        : 0),
        position_(setup.parameters, "Position"),
        turn_(setup.parameters, "Quaternion"),
        linear_(setup.parameters, "LinearVelocity"),
        angular_(setup.parameters, "AngularVelocity"),
        topic_(setup.topics.publishes(topic_of(setup, "odometryTopic"),
                                      messages::kind_of<messages::Odometry>())),
        row_(static_cast<Eigen::Index>(messages::kind_of<messages::Odometry>().fields.size()) + 1) {
    for (const char* tag : {"measurementDivisor", "measurementDelay"}) {
      if (setup.parameters.number(tag) != std::floor(setup.parameters.number(tag))) {
        throw InputError(std::string("<") + tag +
                         "> is not a whole number of steps. Write a whole number.");
      }
    }
  }

  std::size_t state_size() const override {
    return static_cast<std::size_t>(kRing + (static_cast<Eigen::Index>(delay_) + 1) * row_);
  }

  void update(const Sample& sample, PluginState state) const override {
    const double step = state[kSteps];
    state[kSteps] += 1;
    const double stamp = sample.time + sample.dt + unknown_delay_;
    auto now = slot(state, step);
    now[0] = std::fmod(step, divisor_) == 0 ? 1 : 0;
    if (now[0] != 0) {
      messages::Odometry message = truth(sample.kinematics);
      message.position_variance = stamp;  // holds the stamp until the message is due
      messages::write(message, now.data() + 1);
    }
    if (step < delay_) return;
    const auto due = slot(state, step - delay_);
    if (due[0] == 0) return;
    auto message = messages::read<messages::Odometry>(due.data() + 1);
    const double stamped = message.position_variance;
    spoil(message, own_seed_ ? seed_ : sample.seed, state[kDraws]);
    sample.topics.publish(topic_, stamped, message);
  }

  void sense(const Sample& sample, PluginState state) const override {
    if (sample.jumped) state[kSteps] = 0;  // pending messages belong to the previous motion
  }

 private:
  messages::Odometry truth(const Kinematics& k) const {
    const Quaterniond q_FS = X_FS_.rotation();
    const Matrix3d R_SF = q_FS.toRotationMatrix().transpose();
    messages::Odometry message;
    message.position = k.p_WF + k.R_WF * (X_FS_.xyz + R_SF.transpose() * p_SScm_S_);
    message.orientation = k.q_WF * q_FS;
    message.linear_velocity = R_SF * (k.v_WF_F + k.w_WF_F.cross(X_FS_.xyz));
    message.angular_velocity = R_SF * k.w_WF_F;
    return message;
  }

  void spoil(messages::Odometry& message, std::uint64_t seed, double& draws) const {
    message.position += position_.draw(seed, draws);
    const Vector3d half = turn_.draw(seed, draws) / 2;
    const double square = half.squaredNorm();
    const Quaterniond small = square < 1
                                  ? Quaterniond(std::sqrt(1 - square), half.x(), half.y(), half.z())
                                  : Quaterniond(1, half.x(), half.y(), half.z()).normalized();
    message.orientation = message.orientation * small;
    message.linear_velocity += linear_.draw(seed, draws);
    message.angular_velocity += angular_.draw(seed, draws);
    message.position_variance = position_.variance();
    message.orientation_variance = turn_.variance();
    message.linear_velocity_variance = linear_.variance();
    message.angular_velocity_variance = angular_.variance();
  }

  Eigen::Map<VectorXd> slot(PluginState& state, double step) const {
    const auto places = static_cast<std::size_t>(delay_) + 1;
    const auto place = static_cast<Eigen::Index>(ring_index(step, places));
    return {state.data() + kRing + place * row_, row_};
  }

  Pose X_FS_;
  Vector3d p_SScm_S_;
  double divisor_, delay_;  ///< steps
  double unknown_delay_;    ///< s
  bool own_seed_;
  std::uint64_t seed_;
  Noise position_, turn_, linear_, angular_;
  std::size_t topic_;
  Eigen::Index row_;  ///< size of a pending message
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<TagSpec> tags = {
      T::link("linkName", "link of the published motion").must(),
      T::text("odometryTopic", "odometry", "topic of the messages"),
      T::text("poseTopic", "pose", "ROS topic of the pose alone"),
      T::text("poseWithCovarianceTopic", "pose_with_covariance",
              "ROS topic of the pose with covariance"),
      T::text("positionTopic", "position", "ROS topic of the position"),
      T::text("transformTopic", "transform", "ROS topic of the pose as a transform"),
      T::text("childFrameId", "odometry_sensor", "child_frame_id of the ROS messages"),
      T::number("measurementDivisor", "", "1", "number of steps between measurements")
          .at_least(1)
          .at_most(1e9),
      T::number("measurementDelay", "", "0", "delay of a measurement in steps")
          .at_least(0)
          .at_most(10000),
      T::number("unknownDelay", "s", "0",
                "offset of the time stamps; only whole seconds count, as in RotorS")
          .at_least(-1e6)
          .at_most(1e6),
      T::number("randomEngineSeed", "", "", "seed of the noise, a whole number")
          .at_least(0)
          .at_most(4294967295.0)
          .or_absent("the simulation's seed"),
  };
  const auto add = [&](const std::string& of, const char* unit, const char* what) {
    tags.push_back(T::numbers("noiseNormal" + of, unit, "0 0 0",
                              std::string("standard deviations of the normal noise on ") + what)
                       .of(3)
                       .at_least(0));
    tags.push_back(T::numbers("noiseUniform" + of, unit, "0 0 0",
                              std::string("bounds of the uniform noise on ") + what)
                       .of(3)
                       .at_least(0));
  };
  add("Position", "m", "the position");
  add("Quaternion", "rad", "the orientation, a small rotation about the link's axes");
  add("LinearVelocity", "m/s", "the linear velocity, link axes");
  add("AngularVelocity", "rad/s", "the angular velocity, link axes");
  for (TagSpec& tag : tags) tag.equation = "RotorS";
  for (const char* image : {"covarianceImage", "covarianceImageScale"}) {
    tags.push_back(
        idle(image, "messages are published everywhere, not only where an image is white"));
  }
  tags.push_back(T::choice("parentFrameId", {"world"}, "frame of the poses"));
  tags.push_back(namespace_tag());
  return {
      "RotorS' odometry: measures the state one step before the time stamp, with velocities in "
      "link axes",
      tags,
      {},
      create<Odometry>};
}

}  // namespace
}  // namespace quadcore::rotors

QUADCORE_REGISTER_PLUGIN(quadcore::rotors::describe)
