#include "quadcore/plugin.hpp"
#include "shared/mounted_sensor.hpp"
#include "shared/noise_and_drift.hpp"

namespace quadcore::magnetometer {
namespace {

using Errors = sensing::NoiseAndDrift<3>;

/// The uniform magnetic field of the world in the axes of a link of the frame.
class MagnetometerPlugin final
    : public sensing::MountedSensor<messages::Field, Errors::kMemorySize> {
 public:
  explicit MagnetometerPlugin(const PluginSetup& setup)
      : MountedSensor(setup), R_FS_(mounting(setup).rotation()), errors_(setup.parameters) {}

 private:
  std::optional<messages::Field> measure(const Sample& sample, PluginState memory) const override {
    const Matrix3d R_WS = sample.kinematics.R_WF * R_FS_;
    const Vector3d B_S = R_WS.transpose() * sample.world.magnetic_field_W;
    return messages::Field{B_S + errors_.next(sample, memory), errors_.variance().x()};
  }

  Matrix3d R_FS_;  ///< orientation of the link in the frame
  Errors errors_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<TagSpec> tags = {
      T::link("link", "link that carries the sensor; its axes are the sensor's axes"),
      T::number("rate", "1/s", "50", "messages per second; at most one per step").above(0),
      T::text("topic", "magnetic_field", "topic of the messages"),
  };
  Errors::add_tags(tags, "T", "each component of the field");
  tags.push_back(sensing::Channel::delay_tag());
  tags.push_back(sensing::Channel::dropout_tag());
  return {"magnetometer on a link of the frame", tags, {}, create<MagnetometerPlugin>};
}

}  // namespace
}  // namespace quadcore::magnetometer

QUADCORE_REGISTER_PLUGIN(quadcore::magnetometer::describe)
