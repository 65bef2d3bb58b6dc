#include <cmath>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "shared/mounted_sensor.hpp"
#include "shared/noise_and_drift.hpp"

namespace quadcore::barometer {
namespace {

using Errors = sensing::NoiseAndDrift<1>;

/// Static pressure of the world's atmosphere at a link of the frame.
class BarometerPlugin final
    : public sensing::MountedSensor<messages::Pressure, Errors::kMemorySize> {
 public:
  explicit BarometerPlugin(const PluginSetup& setup)
      : MountedSensor(setup), p_FS_F_(mounting(setup).xyz), errors_(setup.parameters) {}

 private:
  std::optional<messages::Pressure> measure(const Sample& sample,
                                            PluginState memory) const override {
    const Kinematics& k = sample.kinematics;
    const double height = k.p_WF.z() + k.R_WF.row(2).dot(p_FS_F_);
    const double error = errors_.next(sample, memory).value();
    return messages::Pressure{pressure(sample, height) + error, errors_.variance().value()};
  }

  /// Return the pressure of a layer with a linear temperature T = T0 + L z, p = p0 (T/T0)^(-g/(R
  /// L)), or of an isothermal layer, p0 exp(-g z/(R T0)) (ISO 2533).
  static double pressure(const Sample& sample, double height) {
    const Atmosphere& air = sample.world.atmosphere;
    const double gradient = air.temperature_gradient;
    const double warmth = 1 + gradient * height / air.temperature;
    if (!(warmth > 0)) {
      throw FlightError(sample.time,
                        "the world's atmosphere is at absolute zero at this height. Use a smaller "
                        "<temperature_gradient>.");
    }
    const double g_by_R = 9.80665 / Atmosphere::gas_constant;
    const double exponent = gradient == 0 ? -g_by_R * height / air.temperature
                                          : -g_by_R / gradient * elementary::log(warmth);
    return air.pressure * elementary::exp(exponent);
  }

  Vector3d p_FS_F_;  ///< position of the link's origin [m]
  Errors errors_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<TagSpec> tags = {
      T::link("link", "link that carries the sensor"),
      T::number("rate", "1/s", "50", "messages per second; at most one per step").above(0),
      T::text("topic", "pressure", "topic of the messages"),
  };
  Errors::add_tags(tags, "Pa", "the pressure");
  tags.push_back(sensing::Channel::delay_tag());
  tags.push_back(sensing::Channel::dropout_tag());
  return {"barometer on a link of the frame", tags, {}, create<BarometerPlugin>};
}

}  // namespace
}  // namespace quadcore::barometer

QUADCORE_REGISTER_PLUGIN(quadcore::barometer::describe)
