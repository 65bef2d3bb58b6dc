#include "naming.hpp"
#include "noise.hpp"
#include "quadcore/plugin.hpp"

namespace quadcore::rotors {
namespace {

/// State: whether it is turned on, the number of random numbers drawn, and the bias in world axes
/// [T].
enum Memory { kOn, kDraws, kBias, kMemorySize = kBias + 3 };

/// The Earth's field in a link's axes at the start of each step. Noise and bias are errors in world
/// axes, which RotorS rotates together with the field.
class Magnetometer final : public Plugin {
 public:
  explicit Magnetometer(const PluginSetup& setup)
      : R_SF_(place_of(setup, "linkName").rotation().toRotationMatrix().transpose()),
        field_W_(setup.parameters.number("refMagNorth"), setup.parameters.number("refMagEast"),
                 setup.parameters.number("refMagDown")),
        noise_(vector_of(setup.parameters, "noiseNormal")),
        bias_(vector_of(setup.parameters, "noiseUniformInitialBias")),
        topic_(setup.topics.publishes(topic_of(setup, "magnetometerTopic"),
                                      messages::kind_of<messages::Field>())) {}

  std::size_t state_size() const override { return kMemorySize; }

  void update(const Sample& sample, PluginState state) const override {
    double& draws = state[kDraws];
    if (state[kOn] == 0) {
      state[kOn] = 1;
      for (int i = 0; i < 3; ++i) state[kBias + i] = uniform_within(bias_[i], sample.seed, draws);
    }
    Vector3d field_W = field_W_ + state.segment<3>(kBias);
    for (int i = 0; i < 3; ++i) field_W[i] += normal_of(noise_[i], sample.seed, draws);
    messages::Field message;
    message.flux_density = R_SF_ * (sample.kinematics.R_WF.transpose() * field_W);
    message.variance = noise_.cwiseAbs2().maxCoeff();
    sample.topics.publish(topic_, sample.time + sample.dt, message);
  }

 private:
  Matrix3d R_SF_;
  Vector3d field_W_;       ///< T
  Vector3d noise_, bias_;  ///< standard deviation, and bound [T]
  std::size_t topic_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<TagSpec> tags = {
      T::link("linkName", "link that carries the sensor").must(),
      T::text("magnetometerTopic", "magnetic_field", "topic of the messages"),
      T::number("refMagNorth", "T", "0.000021493", "component of the field along the world's x"),
      T::number("refMagEast", "T", "0.000000815",
                "component along y, as in RotorS; note that y points west where x points north"),
      T::number("refMagDown", "T", "0.000042795",
                "component along z, as in RotorS; note that z points up"),
      T::numbers("noiseNormal", "T", "0 0 0", "standard deviations of the noise, world axes")
          .of(3)
          .at_least(0),
      T::numbers("noiseUniformInitialBias", "T", "0 0 0",
                 "bounds of the random bias at turn-on, world axes")
          .of(3)
          .at_least(0),
  };
  for (TagSpec& tag : tags) tag.equation = "RotorS";
  tags.push_back(namespace_tag());
  return {
      "RotorS' magnetometer: measures every step, from the state one step before the time stamp",
      tags,
      {},
      create<Magnetometer>};
}

}  // namespace
}  // namespace quadcore::rotors

QUADCORE_REGISTER_PLUGIN(quadcore::rotors::describe)
