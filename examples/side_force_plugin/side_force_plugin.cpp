#include <quadcore/plugin.hpp>

namespace {

using quadcore::TagSpec;

/// Pushes the vehicle with a constant force along the frame's y at its centre of mass.
class SideForcePlugin final : public quadcore::Plugin {
 public:
  explicit SideForcePlugin(const quadcore::PluginSetup& setup)
      : f_F_(0, setup.parameters.number("sideForce"), 0) {}

  void forces(const quadcore::Kinematics& kinematics, quadcore::ConstPluginState,
              quadcore::Loads& loads) const override {
    loads.add_frame_force(0, f_F_, kinematics.p_FCcm_F);
  }

 private:
  quadcore::Vector3d f_F_;  ///< N
};

quadcore::PluginDescriptor describe() {
  return {
      "constant force along the frame's y at the centre of mass",
      {TagSpec::number("sideForce", "N", "", "force, positive along y").must()},
      {"side_force"},
      quadcore::create<SideForcePlugin>,
  };
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
