#include <cmath>
#include <string>
#include <vector>

#include "downwash/turbulent_jet.hpp"
#include "quadcore/plugin.hpp"
#include "shared/rotor_shares.hpp"
#include "shared/rotor_tags.hpp"

namespace quadcore::downwash {
namespace {

/// State: whether each warning has been given, the velocity of the wakes at the frame's origin;
/// then for each rotor its remaining share of thrust and the velocity of the wakes. World axes
/// [m/s].
enum Memory { kSaidBare, kSaidNear, kAir, kRotors = kAir + 3 };
enum OfRotor { kShare, kFlow, kOfRotor = kFlow + 3 };

/// Speed of a wake from which on a vehicle is warned that the model does not hold there, as a part
/// of the induced velocity in hover.
constexpr double felt = 0.01;

/// Wakes of the other vehicles. Their velocity at the frame's origin is wind to all force laws. At
/// each rotor, the part V against the thrust reduces the thrust T0 that the other plugins exert:
/// T = T0 (1 - c J), with the advance ratio J = V/(n D) of the rotor with n turns per second and
/// diameter D.
class DownwashPlugin final : public Plugin {
 public:
  explicit DownwashPlugin(const PluginSetup& setup)
      : radius_(setup.parameters.number("rotorRadius")),
        loss_(setup.parameters.number("advanceRatioLoss")),
        density_(setup.world.atmosphere.density()),
        rotors_(setup.parameters.joints("rotorJoints")),
        effectiveness_(
            setup.topics.takes(setup.parameters.text("effectiveness"), shares(rotors_.size()))) {
    if (rotors_.size() >= 2) return;
    throw InputError(
        "the size of a wake follows from the distance of two rotors, but <rotorJoints> names "
        "fewer. "
        "Name at least two joints.");
  }

  std::size_t state_size() const override { return kRotors + kOfRotor * rotors_.size(); }

  void describe_rotors(std::vector<RotorDescription>& rotors) const override {
    for (const std::size_t i : rotors_) rotors[i].radius = radius_;
  }

  void prepare(const VehicleDescription& vehicle) override {
    for (const std::size_t i : rotors_) undisturbed_.push_back(vehicle.rotors[i]);
  }

  void observe(const Sample& sample, const OtherVehicles& others,
               PluginState state) const override {
    const Kinematics& k = sample.kinematics;
    state.segment<3>(kAir).setZero();
    for (std::size_t j = 0; j < rotors_.size(); ++j) flow(state, j).setZero();
    for (const OtherVehicle* const other : others) {
      const std::optional<TurbulentJet> jet = TurbulentJet::below(*other, density_);
      if (!jet) {
        warn_of_bare(sample, *other, state);
        continue;
      }
      state.segment<3>(kAir) += jet->velocity_at(k.p_WF);
      for (std::size_t j = 0; j < rotors_.size(); ++j) {
        const Vector3d p_FRcm_F = k.rotors.vector(MotionRow::p_FRcm, rotors_[j]);
        flow(state, j) += jet->velocity_at(k.p_WF + k.R_WF * p_FRcm_F);
      }
      warn_of_near(sample, *other, *jet, state);
    }
  }

  void update(const Sample& sample, PluginState state) const override {
    const Topic& left = sample.topics[effectiveness_];
    for (std::size_t j = 0; j < rotors_.size(); ++j) state[place(j) + kShare] = left.values[j];
  }

  void air(const Kinematics&, ConstPluginState state, Vector3d& v_WA_W) const override {
    v_WA_W += state.segment<3>(kAir);
  }

  void forces(const Kinematics& k, ConstPluginState state, Loads& loads) const override {
    if (undisturbed_.empty()) return;
    for (std::size_t j = 0; j < rotors_.size(); ++j) {
      const Vector3d v_W = state.segment<3>(place(j) + kFlow);
      if (v_W.isZero(0)) continue;
      const RotorDescription& rotor = undisturbed_[j];
      const double rate = k.rotors.number(MotionRow::rate, rotors_[j]);
      const Vector3d& force_F = (rate < 0 ? rotor.backward : rotor.forward).force_F;
      const double norm = force_F.norm();
      if (!(norm > 0)) continue;
      const double against = -(k.R_WF.transpose() * v_W).dot(force_F) / norm;
      // T0 J = force rate^2 V / (n D), n = |rate| slowdown / (2 pi), D = 2 radius
      const double per_force = std::abs(rate) * against * M_PI / (rotor.slowdown * radius_);
      loads.add_rotor_force(0, rotors_[j], -state[place(j) + kShare] * loss_ * per_force * force_F);
    }
  }

 private:
  static Eigen::Index place(std::size_t j) {
    return kRotors + static_cast<Eigen::Index>(j) * kOfRotor;
  }
  static Eigen::VectorBlock<PluginState, 3> flow(PluginState& state, std::size_t j) {
    return state.segment<3>(place(j) + kFlow);
  }

  static void warn_of_bare(const Sample& sample, const OtherVehicle& other, PluginState state) {
    for (const OtherRotor& rotor : other.rotors) {
      if (!std::isnan(rotor.radius)) return;  // it has a wake while it has thrust
    }
    if (state[kSaidBare] != 0) return;
    state[kSaidBare] = 1;
    sample.warnings.push_back("vehicle '" + other.name +
                              "' has no wake, because no plugin gives the radius of its rotors. "
                              "Add libdownwash_plugin.so to its model.");
  }

  static void warn_of_near(const Sample& sample, const OtherVehicle& other, const TurbulentJet& jet,
                           PluginState state) {
    const Vector3d& p_W = sample.kinematics.p_WF;
    const double s = jet.depth(p_W);
    if (state[kSaidNear] != 0 || !(s > 0 && s < TurbulentJet::developed)) return;
    if (jet.velocity_at(p_W).norm() < felt * jet.hover_speed) return;
    state[kSaidNear] = 1;
    sample.warnings.push_back(
        "the vehicle is less than 2.5 rotor distances below '" + other.name +
        "', where the wake model does not hold. The wake there is that at 2.5 rotor distances.");
  }

  double radius_;   ///< m
  double loss_;     ///< c
  double density_;  ///< kg/m^3
  std::vector<std::size_t> rotors_;
  std::size_t effectiveness_;                  ///< topic
  std::vector<RotorDescription> undisturbed_;  ///< the rotors without wakes
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "downwash: reduced thrust and wind in the wakes of other vehicles",
      {
          rotor_radius_tag("rotor radius R, from which the wake of this vehicle follows")
              .from("Bauersfeld et al., RA-L (2025), (1)"),
          advance_ratio_loss_tag(
              "relative loss of thrust, c, per advance ratio V/(n 2R) of a flow V against "
              "it; n in turns per second")
              .from("APC Slow Flyer 10x4.7, UIUC Propeller Database"),
          effectiveness_tag(),
          T::joints("rotorJoints", "the rotors"),
      },
      {"downwash"},
      create<DownwashPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::downwash

QUADCORE_REGISTER_PLUGIN(quadcore::downwash::describe)
