#include <algorithm>
#include <vector>

#include "quadcore/plugin.hpp"
#include "shared/rotor_shares.hpp"
#include "shared/rotor_tags.hpp"

namespace quadcore::ground_effect {
namespace {

/// Minimum height of a rotor for the formula, in radii.
constexpr double lowest = 0.5;

/// Additional thrust of a rotor of radius R at height z (Cheeseman, Bennett, 1955, in hover):
/// T/T0 = 1/(1 - (R/4z)^2).
class GroundEffectPlugin final : public Plugin {
 public:
  explicit GroundEffectPlugin(const PluginSetup& setup)
      : radius_(setup.parameters.number("rotorRadius")),
        rotors_(setup.parameters.joints("rotorJoints")),
        effectiveness_(
            setup.topics.takes(setup.parameters.text("effectiveness"), shares(rotors_.size()))) {
    if (!setup.world.ground_plane) {
      setup.warnings.push_back(
          "the world has no ground plane, so there is no ground effect. Use a world with a ground "
          "plane.");
    }
    ground_ = setup.world.ground_plane;
  }

  /// Relative thrust of each rotor; all 0 until a step begins, such that the description of the
  /// vehicle is that far from the ground.
  std::size_t state_size() const override { return rotors_.size(); }

  void prepare(const VehicleDescription& vehicle) override {
    for (const std::size_t i : rotors_) thrusts_.push_back(vehicle.rotors[i]);
  }

  void update(const Sample& sample, PluginState state) const override {
    const Topic& left = sample.topics[effectiveness_];
    for (std::size_t j = 0; j < rotors_.size(); ++j) {
      state[static_cast<Eigen::Index>(j)] = left.values[j];
    }
  }

  void forces(const Kinematics& k, ConstPluginState state, Loads& loads) const override {
    if (!ground_ || thrusts_.empty()) return;
    for (std::size_t j = 0; j < rotors_.size(); ++j) {
      const Vector3d p_FR_F = k.rotors.vector(MotionRow::p_FRcm, rotors_[j]);
      const double z = k.p_WF.z() + k.R_WF.row(2).dot(p_FR_F);
      if (!(z > 0)) continue;
      const double x = radius_ / (4 * std::max(z, lowest * radius_));
      const double gain = x * x / (1 - x * x);
      const double rate = k.rotors.number(MotionRow::rate, rotors_[j]);
      const Wrench& thrust = rate < 0 ? thrusts_[j].backward : thrusts_[j].forward;
      loads.add_rotor_force(
          0, rotors_[j], state[static_cast<Eigen::Index>(j)] * gain * rate * rate * thrust.force_F);
    }
  }

 private:
  double radius_;  ///< m
  std::vector<std::size_t> rotors_;
  std::size_t effectiveness_;  ///< topic
  bool ground_;
  std::vector<RotorDescription> thrusts_;  ///< far from the ground
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "ground effect: increased thrust near the ground",
      {
          rotor_radius_tag(
              "rotor radius R; T/T0 = 1/(1 - (R/4z)^2) at the height z of the rotor's centre "
              "of mass, constant below R/2")
              .from("Cheeseman, Bennett, ARC R&M 3021 (1955)"),
          effectiveness_tag(),
          T::joints("rotorJoints", "the rotors"),
      },
      {"ground_effect"},
      create<GroundEffectPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::ground_effect

QUADCORE_REGISTER_PLUGIN(quadcore::ground_effect::describe)
