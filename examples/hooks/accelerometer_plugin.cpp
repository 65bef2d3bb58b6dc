#include <cmath>
#include <quadcore/plugin.hpp>

namespace {

using quadcore::Matrix3d;
using quadcore::Pose;
using quadcore::TagSpec;
using quadcore::Vector3d;
namespace messages = quadcore::messages;

/// State of the sensor after its last sample: the sample's number plus one, its time, and the
/// velocity at that time.
enum Memory { kSamples, kTime, kVelocity, kMemorySize = kVelocity + 3 };

/// Measures the specific force at the origin of a link, ((v - v_last)/T - g): the mean since the
/// last sample, in the present axes of the link, like Gazebo's sensor.
class AccelerometerPlugin final : public quadcore::Plugin {
 public:
  explicit AccelerometerPlugin(const quadcore::PluginSetup& setup)
      : rate_(setup.parameters.number("rate")),
        X_FS_(setup.model.pose_of_link.at(setup.parameters.choice("link"))),
        R_FS_(X_FS_.rotation()),
        topic_(setup.topics.publishes("specific_force", messages::kind_of<messages::Vector>())) {}

  std::size_t state_size() const override { return kMemorySize; }

  void sense(const quadcore::Sample& sample, quadcore::PluginState state) const override {
    const double due = std::floor(sample.time * rate_ + 1e-6) + 1;
    if (due == state[kSamples] && !sample.jumped) return;
    const quadcore::Kinematics& k = sample.kinematics;
    const Vector3d v_WS_W = k.v_WS_W(X_FS_.xyz);
    if (!sample.jumped) {
      const Vector3d delta_v_W = v_WS_W - state.segment<3>(kVelocity);
      const Vector3d f_W = delta_v_W / (sample.time - state[kTime]) - sample.world.gravity_W;
      const messages::Vector f_S{(k.R_WF * R_FS_).transpose() * f_W};
      sample.topics.publish(topic_, sample.time, f_S);
    }
    state[kSamples] = due;
    state[kTime] = sample.time;
    state.segment<3>(kVelocity) = v_WS_W;
  }

 private:
  double rate_;    ///< 1/s
  Pose X_FS_;      ///< pose of the link in the frame
  Matrix3d R_FS_;  ///< its rotation
  std::size_t topic_;
};

quadcore::PluginDescriptor describe() {
  return {
      "specific force at a link of the frame, on topic specific_force",
      {TagSpec::link("link", "link that carries the sensor").must(),
       TagSpec::number("rate", "1/s", "200", "samples per second; at most one per step").above(0)},
      {},
      quadcore::create<AccelerometerPlugin>,
  };
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
