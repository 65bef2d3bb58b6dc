#include <cmath>
#include <stdexcept>

#include "quadcore/plugin.hpp"

namespace {

using namespace quadcore;

/// Throws from the hook that its tag names, once the clock is past its time.
class ThrowingPlugin final : public Plugin {
 public:
  explicit ThrowingPlugin(const PluginSetup& setup)
      : hook_(setup.parameters.choice("hook")), after_(setup.parameters.number("after")) {
    if (hook_ == "create") throw std::runtime_error("no luck");
  }

  std::size_t state_size() const override { return 1; }
  void update(const Sample& sample, PluginState state) const override {
    state[0] = sample.time;
    if (hook_ == "update" && sample.time > after_) throw std::runtime_error("no luck");
    if (hook_ == "number" && sample.time > after_) throw 7;
  }
  void sense(const Sample& sample, PluginState) const override {
    if (hook_ == "sense" && sample.time > after_) throw std::runtime_error("no luck");
    if (hook_ == "input" && sample.time > after_) throw InputError("no luck");
  }
  void forces(const Kinematics& motion, ConstPluginState state, Loads& loads) const override {
    // A description of the vehicle probes it with the initial state of the plugins.
    if (hook_ == "probe" && motion.time > after_ && state[0] == 0) throw InputError("no luck");
    if (hook_ == "forces" && state[0] > after_) throw std::runtime_error("no luck");
    if (state[0] <= after_) return;
    if (hook_ == "nan") loads.add_frame_torque(0, Vector3d::Constant(NAN));
    if (hook_ == "huge") loads.add_frame_torque(0, Vector3d::Constant(1e300));
  }

 private:
  std::string hook_;
  double after_;
};

PluginDescriptor describe() {
  return {"throws",
          {TagSpec::choice("hook",
                           {"none", "create", "update", "number", "sense", "input", "forces",
                            "probe", "nan", "huge"},
                           "which hook throws"),
           TagSpec::number("after", "s", "0", "when").at_least(0)},
          {"luck"},
          create<ThrowingPlugin>};
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
