#include <stdexcept>

#include "quadcore/plugin.hpp"

namespace {

using namespace quadcore;

/// Has every hook: carries a body until its time, in a wind that grows. Tells itself where it is.
class LadenPlugin final : public Plugin {
 public:
  explicit LadenPlugin(const PluginSetup& setup) : until_(setup.parameters.number("until")) {
    body_.name = name_;
    body_.pose.xyz = {0.03, -0.02, -0.1};
    body_.inertial.mass = 0.2;
    body_.inertial.inertia.diagonal() = Vector3d(1e-4, 2e-4, 2.5e-4);
    const MessageKind kind = messages::kind_of<messages::Vector>();
    place_ = setup.topics.publishes("place", kind);
    place_before_ = setup.topics.takes("place", kind, true);
  }

  std::size_t state_size() const override { return 1; }
  void prepare(const VehicleDescription& vehicle) override { mass_ = vehicle.body.mass; }
  void update(const Sample& sample, PluginState state) const override {
    state[0] = sample.time;
    sample.topics.publish(place_, sample.time, messages::Vector{sample.kinematics.p_WF});
    const Topic& before = sample.topics[place_before_];
    if (before.count != sample.topics[place_].count - 1) throw std::logic_error("not late");
  }
  void sense(const Sample& sample, PluginState) const override {
    if (sample.kinematics.time != sample.time) throw std::logic_error("another time");
  }
  void carried(ConstPluginState state, std::vector<CarriedBody>& bodies) const override {
    if (state[0] < until_) bodies.push_back(body_);
  }
  void air(const Kinematics& k, ConstPluginState, Vector3d& v_WA_W) const override {
    v_WA_W.x() += k.time;
  }
  void forces(const Kinematics& k, ConstPluginState, Loads& loads) const override {
    loads.add_frame_force(0, 0.1 * mass_ * (k.v_WA_F - k.v_WF_F), k.p_FCcm_F);
  }

 private:
  std::size_t place_, place_before_;
  std::string name_ = "a name too long for a string to hold in itself";
  CarriedBody body_;
  double until_;  ///< s
  double mass_ = 0;
};

PluginDescriptor describe() {
  return {"carries",
          {TagSpec::number("until", "s", "", "when it lets go").must()},
          {"drag"},
          create<LadenPlugin>};
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
