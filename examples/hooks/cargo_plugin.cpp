#include <cmath>
#include <quadcore/plugin.hpp>

namespace {

using quadcore::TagSpec;

/// Attaches a ball to the frame and releases it in flight.
class CargoPlugin final : public quadcore::Plugin {
 public:
  explicit CargoPlugin(const quadcore::PluginSetup& setup)
      : name_(setup.name),
        release_(setup.parameters.has("release") ? setup.parameters.number("release") : INFINITY) {
    const double mass = setup.parameters.number("mass"), radius = setup.parameters.number("radius");
    ball_.name = name_;
    ball_.pose.xyz = {setup.parameters.number("x"), setup.parameters.number("y"),
                      setup.parameters.number("z")};
    ball_.inertial.mass = mass;
    ball_.inertial.inertia = 0.4 * mass * radius * radius * quadcore::Matrix3d::Identity();
  }

  std::size_t state_size() const override { return 1; }

  void update(const quadcore::Sample& sample, quadcore::PluginState state) const override {
    if (sample.time >= release_ - 1e-9) state[0] = 1;  // the clock is a sum of steps
  }

  void carried(quadcore::ConstPluginState state,
               std::vector<quadcore::CarriedBody>& bodies) const override {
    const bool is_gone = state[0] != 0;
    if (!is_gone) bodies.push_back(ball_);
  }

 private:
  std::string name_;
  quadcore::CarriedBody ball_;
  double release_;  ///< s
};

quadcore::PluginDescriptor describe() {
  return {
      "ball that rides on the frame until its release",
      {TagSpec::number("mass", "kg", "", "mass of the ball").must().above(0),
       TagSpec::number("radius", "m", "", "radius of the ball").must().above(0),
       TagSpec::number("x", "m", "0", "position of its centre in the frame, along x"),
       TagSpec::number("y", "m", "0", "along y"), TagSpec::number("z", "m", "0", "along z"),
       TagSpec::number("release", "s", "", "time of the release").or_absent("never")},
      {},
      quadcore::create<CargoPlugin>,
  };
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
