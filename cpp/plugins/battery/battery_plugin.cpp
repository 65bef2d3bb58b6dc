#include <cmath>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/error.hpp"
#include "shared/rotor_shares.hpp"

namespace quadcore::battery {
namespace {

/// State: whether it has begun, and the remaining charge [A h].
enum Memory { kBegun, kCharge, kMemorySize };

/// A battery with a voltage that falls with its charge and with the current, as in Gazebo's
/// LinearBatteryPlugin: E = Ee + (Ef - Ee) q/Q and U = E - R I. Speed controllers that set a duty
/// cycle without measuring the speed turn a rotor in proportion to the voltage (Bangura, Mahony,
/// IEEE T-RO 33 (2017)): at U/Ef of the commanded speed. This leaves (U/Ef)^2 of thrust and
/// reaction torque and (U/Ef)^3 of their power.
class BatteryPlugin final : public Plugin {
 public:
  explicit BatteryPlugin(const PluginSetup& setup)
      : rotors_(setup.parameters.joints("rotorJoints")),
        full_(setup.parameters.number("fullVoltage")),
        empty_(setup.parameters.number("emptyVoltage")),
        capacity_(setup.parameters.number("capacity")),
        resistance_(setup.parameters.number("resistance")),
        at_start_(setup.parameters.number("charge")),
        efficiency_(setup.parameters.number("efficiency")),
        topic_(setup.topics.publishes(setup.parameters.text("topic"),
                                      messages::kind_of<messages::Battery>())),
        effectiveness_(setup.topics.publishes(
            setup.parameters.text("effectiveness"),
            shares(rotors_.size(), "each rotor's thrust and reaction torque"))),
        power_(setup.topics.takes(setup.parameters.text("power"), shares(rotors_.size()))),
        has_faults_(setup.parameters.has("faults")) {
    if (has_faults_) {
      faults_ = setup.topics.takes(setup.parameters.text("faults"), shares(rotors_.size()));
    }
    if (empty_ > full_) throw InputError("<emptyVoltage> exceeds <fullVoltage>. Swap them.");
  }

  std::size_t state_size() const override { return kMemorySize; }

  void prepare(const VehicleDescription& vehicle) override {
    for (const std::size_t i : rotors_) {
      const RotorDescription& rotor = vehicle.rotors[i];
      const Vector3d p_CR_F = rotor.p_FRcm_F - vehicle.body.p_FCcm;
      const double slowed = 1 / rotor.slowdown;
      const auto coefficient = [&](const Wrench& wrench) {
        const Vector3d torque_F = wrench.torque_F - p_CR_F.cross(wrench.force_F);
        return std::abs(rotor.axis_F.dot(torque_F)) / slowed;
      };
      coefficients_.push_back({coefficient(rotor.forward), coefficient(rotor.backward)});
    }
  }

  void update(const Sample& sample, PluginState state) const override {
    if (state[kBegun] == 0) {
      state[kBegun] = 1;
      state[kCharge] = at_start_ * capacity_;
    }
    if (has_faults_) check_shares(sample.topics[faults_], sample.time);
    const bool is_empty = state[kCharge] <= 0;
    const double E = empty_ + (full_ - empty_) * state[kCharge] / capacity_;
    // I = g U^2, and with U = E - R I that is a quadratic equation in U.
    const double g = power(sample) / (full_ * full_ * full_);
    const double U = is_empty ? 0 : 2 * E / (1 + std::sqrt(1 + 4 * resistance_ * g * E));
    const double I = g * U * U;
    sample.topics.publish(topic_, sample.time, messages::Battery{U, I, state[kCharge], capacity_});
    double* left = sample.topics.publish(effectiveness_, sample.time);
    for (std::size_t j = 0; j < rotors_.size(); ++j) {
      left[j] = share_of_fault(sample, j) * (U / full_) * (U / full_);
    }
    state[kCharge] = std::fmax(state[kCharge] - I * sample.dt / 3600, 0);
  }

 private:
  /// Aerodynamic power at the commanded speed divided by the cubed joint rate, for both directions
  /// of rotation [W s^3/rad^3].
  struct Coefficients {
    double forward, backward;
  };

  double share_of_fault(const Sample& sample, std::size_t j) const {
    return has_faults_ ? sample.topics[faults_].values[j] : 1;
  }

  /// Return the power that the rotors would draw from a full battery [W].
  double power(const Sample& sample) const {
    double power = 0;
    for (std::size_t j = 0; j < rotors_.size(); ++j) {
      const double rate = sample.kinematics.rotors.number(MotionRow::rate, rotors_[j]);
      const Coefficients& c = coefficients_[j];
      const double cube = std::abs(rate) * rate * rate;
      const double driven = sample.topics[power_].values[j];
      power += driven * share_of_fault(sample, j) * (rate < 0 ? c.backward : c.forward) * cube;
    }
    return power / efficiency_;
  }

  std::vector<std::size_t> rotors_;
  double full_, empty_;  ///< voltages [V]
  double capacity_;      ///< A h
  double resistance_;    ///< ohm
  double at_start_;      ///< fraction of the capacity
  double efficiency_;
  std::size_t topic_, effectiveness_, power_, faults_ = 0;
  bool has_faults_;
  std::vector<Coefficients> coefficients_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  const std::string gazebo = "Gazebo's LinearBatteryPlugin";
  return {
      "battery with falling voltage, which reduces the thrust for a given command",
      {
          T::number("fullVoltage", "V", "",
                    "open-circuit voltage of the full battery, at which the rotors follow their "
                    "commands exactly")
              .must()
              .above(0)
              .from(gazebo),
          T::number("emptyVoltage", "V", "",
                    "open-circuit voltage of the empty battery; linear in the charge in between")
              .must()
              .above(0)
              .from(gazebo),
          T::number("capacity", "A h", "",
                    "charge of the full battery; once it is empty, the thrust is zero")
              .must()
              .above(0),
          T::number("resistance", "ohm", "", "internal resistance").must().at_least(0).from(gazebo),
          T::number("charge", "", "1", "state of charge at the start").at_least(0).at_most(1),
          T::number("efficiency", "", "1",
                    "efficiency of motors and speed controllers: aerodynamic rotor power divided "
                    "by battery power")
              .above(0)
              .at_most(1),
          T::text("topic", "battery", "topic of voltage, current and charge"),
          effectiveness_tag(),
          power_tag(),
          T::text("faults", "",
                  "topic of fractions that multiply the battery's own: use the effectiveness topic "
                  "of libfault_plugin.so, if present")
              .or_absent("none"),
          T::joints("rotorJoints", "rotors that the battery supplies"),
      },
      {},
      create<BatteryPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::battery

QUADCORE_REGISTER_PLUGIN(quadcore::battery::describe)
