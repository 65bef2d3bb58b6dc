#include <algorithm>
#include <cmath>
#include <quadcore/plugin.hpp>

namespace {

/// Commands the hover speed of the rotors, with alternating signs. It works for any mass and for
/// any plugin that exerts the thrust.
class HoverPlugin final : public quadcore::Plugin {
 public:
  explicit HoverPlugin(const quadcore::PluginSetup& setup) {
    speeds_.resize(setup.model.joints.size());
    topic_ = setup.topics.publishes("vel_cmd", quadcore::messages::speeds(speeds_.size()));
  }

  void prepare(const quadcore::VehicleDescription& vehicle) override {
    double lift = 0;  // N s^2/rad^2
    for (std::size_t i = 0; i < speeds_.size(); ++i) {
      const quadcore::RotorDescription& rotor = vehicle.rotors[i];
      lift += (i % 2 == 0 ? rotor.forward : rotor.backward).force_F.z();
    }
    if (!(lift > 0)) throw quadcore::InputError("the rotors lift nothing; add their force laws");
    const double speed = std::sqrt(vehicle.body.mass * vehicle.gravity_W.norm() / lift);
    for (std::size_t i = 0; i < speeds_.size(); ++i) speeds_[i] = i % 2 == 0 ? speed : -speed;
  }

  void update(const quadcore::Sample& sample, quadcore::PluginState) const override {
    std::copy(speeds_.begin(), speeds_.end(), sample.topics.publish(topic_, sample.time));
  }

 private:
  std::vector<double> speeds_;  ///< rad/s
  std::size_t topic_;
};

quadcore::PluginDescriptor describe() {
  return {"command of the rotor speeds of a hover", {}, {}, quadcore::create<HoverPlugin>};
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
