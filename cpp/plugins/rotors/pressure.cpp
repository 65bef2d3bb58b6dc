#include <cmath>

#include "naming.hpp"
#include "noise.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::rotors {
namespace {

/// Of the air at a height above the sea [m], up to 11 km (U.S. Standard Atmosphere, 1976, eqs.
/// (18), (23), (33a)) [Pa].
double standard_pressure(double height) {
  constexpr double earth_radius = 6356766;                        // m
  constexpr double temperature_0 = 288.15, lapse = 0.0065;        // K, K/m
  constexpr double gravity = 9.80665;                             // m/s^2
  constexpr double molar_mass = 28.9644, gas_constant = 8314.32;  // kg/kmol, N m/(kmol K)
  constexpr double pressure_0 = 101325;                           // Pa
  const double geopotential = earth_radius * height / (earth_radius + height);
  const double temperature = temperature_0 - lapse * geopotential;
  return pressure_0 * elementary::exp(gravity * molar_mass / (gas_constant * lapse) *
                                      elementary::log(temperature / temperature_0));
}

/// The air pressure at the frame's origin at the start of each step. Its memory is the number of
/// random numbers drawn.
class Pressure final : public Plugin {
 public:
  explicit Pressure(const PluginSetup& setup)
      : altitude_(setup.parameters.number("referenceAltitude")),
        variance_(setup.parameters.number("pressureVariance")),
        topic_(setup.topics.publishes(topic_of(setup, "pressureTopic"),
                                      messages::kind_of<messages::Pressure>())) {
    place_of(setup, "linkName");  // RotorS uses the vehicle's height but requires the link
  }

  std::size_t state_size() const override { return 1; }

  void update(const Sample& sample, PluginState draws) const override {
    messages::Pressure message;
    message.pressure = standard_pressure(altitude_ + sample.kinematics.p_WF.z()) +
                       normal_of(std::sqrt(variance_), sample.seed, draws[0]);
    message.variance = variance_;
    sample.topics.publish(topic_, sample.time + sample.dt, message);
  }

 private:
  double altitude_;  ///< m
  double variance_;  ///< Pa^2
  std::size_t topic_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "RotorS' air-pressure sensor: measures every step, from the state one step before the time "
      "stamp",
      {
          T::link("linkName", "link that carries the sensor, part of the frame")
              .must()
              .from("RotorS"),
          T::text("pressureTopic", "air_pressure", "topic of the messages").from("RotorS"),
          T::number("referenceAltitude", "m", "500", "height of the world's origin above sea level")
              .at_least(-1000)
              .at_most(10000)
              .from("RotorS"),
          T::number("pressureVariance", "Pa^2", "0", "variance of the noise")
              .at_least(0)
              .from("RotorS"),
          namespace_tag(),
      },
      {},
      create<Pressure>,
  };
}

}  // namespace
}  // namespace quadcore::rotors

QUADCORE_REGISTER_PLUGIN(quadcore::rotors::describe)
