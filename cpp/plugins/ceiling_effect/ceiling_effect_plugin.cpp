#include <cmath>
#include <vector>

#include "quadcore/plugin.hpp"
#include "quadcore/ray.hpp"
#include "shared/rotor_shares.hpp"
#include "shared/rotor_tags.hpp"

namespace quadcore::ceiling_effect {
namespace {

/// State of each rotor: its remaining share of thrust, and its radius divided by the distance of
/// the ceiling; 0 without a ceiling.
enum OfRotor { kShare, kNearness, kOfRotor };

/// Additional thrust of a rotor below a ceiling at constant speed.
///
/// Momentum theory with the suction between rotor and ceiling gives the inflow v = sqrt(T/(2 rho
/// A))/gamma with gamma = 1/2 + 1/2 sqrt(1 + (R/d)^2/8) at the distance d (Hsiao, Chirarattananon,
/// IEEE/ASME T-MECH 24, 2019). The thrust of a blade of constant speed falls linearly with the
/// inflow: T = T0 (1 + b (1 - v/v0)), where v0 is the inflow without ceiling. Both give a quadratic
/// equation of sqrt(T/T0).
class CeilingEffectPlugin final : public Plugin {
 public:
  explicit CeilingEffectPlugin(const PluginSetup& setup)
      : radius_(setup.parameters.number("rotorRadius")),
        loss_(setup.parameters.number("advanceRatioLoss")),
        density_(setup.world.atmosphere.density()),
        rotors_(setup.parameters.joints("rotorJoints")),
        effectiveness_(
            setup.topics.takes(setup.parameters.text("effectiveness"), shares(rotors_.size()))) {
    if (!setup.world.obstacles.empty()) return;
    setup.warnings.push_back(
        "the world has no obstacles, so only the ground above a vehicle that is upside down has a "
        "ceiling effect. Use a world with obstacles.");
  }

  std::size_t state_size() const override { return kOfRotor * rotors_.size(); }

  void prepare(const VehicleDescription& vehicle) override {
    for (const std::size_t i : rotors_) {
      forward_.push_back(thrust_of(vehicle.rotors[i], vehicle.rotors[i].forward));
      backward_.push_back(thrust_of(vehicle.rotors[i], vehicle.rotors[i].backward));
    }
  }

  void update(const Sample& sample, PluginState state) const override {
    const Topic& left = sample.topics[effectiveness_];
    const Kinematics& k = sample.kinematics;
    for (std::size_t j = 0; j < rotors_.size(); ++j) {
      const Vector3d p_FR_F = k.rotors.vector(MotionRow::p_FRcm, rotors_[j]);
      const Thrust& thrust = thrust_at(k, j);
      const Ray up{k.p_WF + k.R_WF * p_FR_F, k.R_WF * thrust.direction_F};
      state[place(j) + kShare] = left.values[j];
      state[place(j) + kNearness] = radius_ / range_along(up, sample.world, INFINITY);
    }
  }

  void forces(const Kinematics& k, ConstPluginState state, Loads& loads) const override {
    if (forward_.empty()) return;
    for (std::size_t j = 0; j < rotors_.size(); ++j) {
      const double nearness = state[place(j) + kNearness];
      if (nearness == 0) continue;
      const Thrust& thrust = thrust_at(k, j);
      const double rate = k.rotors.number(MotionRow::rate, rotors_[j]);
      loads.add_rotor_force(
          0, rotors_[j],
          state[place(j) + kShare] * (thrust.ratio(nearness) - 1) * rate * rate * thrust.force_F);
    }
  }

 private:
  /// Thrust of a rotor that turns in one direction, without ceiling.
  struct Thrust {
    Vector3d force_F;      ///< per squared joint rate [N s^2/rad^2]
    Vector3d direction_F;  ///< unit vector, or zero
    double slope;          ///< b: relative loss of thrust per relative gain of inflow

    /// Return T/T0.
    /// \param nearness  R/d
    double ratio(double nearness) const {
      const double gamma = 0.5 + 0.5 * std::sqrt(1 + nearness * nearness / 8);
      const double half = slope / gamma / 2;
      const double root = std::sqrt(half * half + 1 + slope) - half;
      return root * root;
    }
  };

  Thrust thrust_of(const RotorDescription& rotor, const Wrench& per_square) const {
    const double force = per_square.force_F.norm();
    if (!(force > 0)) return {Vector3d::Zero(), Vector3d::Zero(), 0};
    // In hover, the inflow V and the advance ratio V/(n D) do not depend on the speed.
    const double inflow = std::sqrt(force / (2 * density_ * M_PI * radius_ * radius_));
    const double lost = loss_ * inflow * M_PI / (rotor.slowdown * radius_);
    if (!(lost < 1)) {
      throw InputError(
          "<advanceRatioLoss> is too large: the rotor's own inflow would stop its thrust. Use a "
          "smaller number, or a larger <rotorRadius>.");
    }
    return {per_square.force_F, per_square.force_F / force, 2 * lost / (1 - lost)};
  }

  const Thrust& thrust_at(const Kinematics& k, std::size_t j) const {
    return k.rotors.number(MotionRow::rate, rotors_[j]) < 0 ? backward_[j] : forward_[j];
  }

  static Eigen::Index place(std::size_t j) { return static_cast<Eigen::Index>(j) * kOfRotor; }

  double radius_;   ///< m
  double loss_;     ///< relative loss of thrust per advance ratio
  double density_;  ///< kg/m^3
  std::vector<std::size_t> rotors_;
  std::size_t effectiveness_;               ///< topic
  std::vector<Thrust> forward_, backward_;  ///< for both directions of rotation
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "ceiling effect: increased thrust below obstacles",
      {
          rotor_radius_tag("rotor radius R").from("Hsiao, Chirarattananon, T-MECH 24 (2019)"),
          advance_ratio_loss_tag("relative loss of thrust per advance ratio V/(n 2R), as in "
                                 "libdownwash_plugin.so"),
          effectiveness_tag(),
          T::joints("rotorJoints", "the rotors"),
      },
      {"ceiling_effect"},
      create<CeilingEffectPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::ceiling_effect

QUADCORE_REGISTER_PLUGIN(quadcore::ceiling_effect::describe)
