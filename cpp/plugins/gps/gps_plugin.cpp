#include "earth.hpp"
#include "quadcore/plugin.hpp"
#include "shared/mounted_sensor.hpp"
#include "shared/noise_and_drift.hpp"

namespace quadcore::gps {
namespace {

using Errors = sensing::NoiseAndDrift<3>;

/// Position and velocity of a link of the frame as measured by a GPS receiver.
class GpsPlugin final : public sensing::MountedSensor<messages::Fix, Errors::kMemorySize> {
 public:
  explicit GpsPlugin(const PluginSetup& setup)
      : MountedSensor(setup),
        p_FS_F_(mounting(setup).xyz),
        earth_({setup.parameters.number("latitude"), setup.parameters.number("longitude"),
                setup.parameters.number("altitude")}),
        errors_(along(setup, "Noise"), along(setup, "Drift"), setup.parameters.number("driftTime")),
        velocity_noise_(setup.parameters.number("velocityNoise")) {}

 private:
  static Vector3d along(const PluginSetup& setup, const std::string& what) {
    const double level = setup.parameters.number("horizontal" + what);
    return {level, level, setup.parameters.number("vertical" + what)};
  }

  std::optional<messages::Fix> measure(const Sample& sample, PluginState memory) const override {
    const Vector3d error = errors_.next(sample, memory), variance = errors_.variance();
    const Kinematics& k = sample.kinematics;
    messages::Fix fix;
    fix.position = k.p_WF + k.R_WF * p_FS_F_ + error;
    fix.velocity = k.v_WS_W(p_FS_F_) + velocity_noise_ * Errors::draw(sample, memory);
    earth_.locate(fix);
    fix.horizontal_variance = variance.x();
    fix.vertical_variance = variance.z();
    fix.velocity_variance = velocity_noise_ * velocity_noise_;
    return fix;
  }

  Vector3d p_FS_F_;  ///< position of the link's origin [m]
  Earth earth_;
  Errors errors_;          ///< errors of the position in world axes [m]
  double velocity_noise_;  ///< m/s
};

PluginDescriptor describe() {
  using T = TagSpec;
  const auto deviation = [](const char* name, const char* unit, const char* of) {
    return T::number(name, unit, "0", std::string("standard deviation of ") + of).at_least(0);
  };
  return {
      "GPS receiver on a link of the frame",
      {
          T::link("link", "link with the antenna at its origin"),
          T::number("rate", "1/s", "10", "messages per second; at most one per step").above(0),
          T::text("topic", "fix", "topic of the messages"),
          T::number("latitude", "deg", "0", "latitude of the world's origin, positive north")
              .at_least(-89)
              .at_most(89),
          T::number("longitude", "deg", "0", "longitude of the world's origin, positive east")
              .at_least(-180)
              .at_most(180),
          T::number("altitude", "m", "0", "altitude of the world's origin").at_least(-1000),
          deviation("horizontalNoise", "m", "the white noise on each of x and y"),
          deviation("verticalNoise", "m", "the white noise on z"),
          deviation("horizontalDrift", "m",
                    "a drifting error of each of x and y, a Gauss-Markov process"),
          deviation("verticalDrift", "m", "a drifting error of z, a Gauss-Markov process"),
          Errors::drift_time_tag(),
          deviation("velocityNoise", "m/s", "the white noise on each component of the velocity"),
          sensing::Channel::delay_tag(),
          sensing::Channel::dropout_tag(),
      },
      {},
      create<GpsPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::gps

QUADCORE_REGISTER_PLUGIN(quadcore::gps::describe)
