#include <quadcore/plugin.hpp>

namespace {

using quadcore::TagSpec;
using quadcore::Vector3d;

/// State: the position in the random sequence, and the force of this step.
enum Memory { kDraws, kForce, kMemorySize = kForce + 3 };

/// Exerts a random force at the centre of mass, a new one in each step.
class BuffetPlugin final : public quadcore::Plugin {
 public:
  explicit BuffetPlugin(const quadcore::PluginSetup& setup)
      : deviation_(setup.parameters.number("deviation")) {}

  std::size_t state_size() const override { return kMemorySize; }

  void update(const quadcore::Sample& sample, quadcore::PluginState state) const override {
    for (int i = kForce; i < kMemorySize; ++i) {
      state[i] = deviation_ * quadcore::random_normal(sample.seed, state[kDraws]);
    }
  }

  void forces(const quadcore::Kinematics& kinematics, quadcore::ConstPluginState state,
              quadcore::Loads& loads) const override {
    loads.add_frame_force(0, state.segment<3>(kForce), kinematics.p_FCcm_F);
  }

 private:
  double deviation_;  ///< N
};

quadcore::PluginDescriptor describe() {
  return {
      "random force at the centre of mass",
      {TagSpec::number("deviation", "N", "", "standard deviation of each component").must()},
      {"buffet"},
      quadcore::create<BuffetPlugin>,
  };
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
