#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "laws/airframe.hpp"
#include "laws/rotor_forces.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/rotor_rows.hpp"
#include "quadcore/plugin/tags.hpp"
#include "quadcore/plugin/world.hpp"

namespace quadcore::aerodynamic {

using laws::RotorLaws;

/// Source of the force laws' coefficients.
struct Given {
  const Parameters& parameters;
  double density_ratio;  ///< air density divided by that of the coefficients
  double reaction_sign;  ///< 1 for a reaction torque along the spin, -1 opposing it
  bool appendix;         ///< dragModel
  double factor = 1;     ///< factor of thrust and reaction torque of one rotor

  /// Return the values of a force law's tags.
  template <std::size_t n>
  std::array<double, n> numbers(const laws::Tag (&tags)[n]) const {
    std::array<double, n> numbers;
    for (std::size_t i = 0; i < n; ++i) numbers[i] = parameters.number(tags[i].name);
    return numbers;
  }
};

/// Force laws of all rotors; they do not act on rotors of other plugins.
struct RotorTable {
  RotorLaws::Places acting;
  RotorRows<RotorLaws::rows> coefficients;

  explicit RotorTable(std::size_t rotor_count) : acting(0), coefficients(rotor_count) {}

  void put(std::size_t rotor, const RotorLaws::Coefficients<double>& of_rotor) {
    acting |= RotorLaws::acting(of_rotor);
    double numbers[RotorLaws::rows];
    std::memcpy(numbers, &of_rotor, sizeof numbers);
    for (std::size_t row = 0; row < RotorLaws::rows; ++row) {
      coefficients.number(row, rotor) = numbers[row];
    }
  }
};

/// Configuration of the force laws by the tags.
class Config {
 public:
  Config(const Parameters& p, std::size_t rotor_count, const Atmosphere& air)
      : Config(p, rotor_count, read(p, air)) {}

  double sim_slow;
  bool appendix;  ///< dragModel
  bool on_rotor;  ///< reactionOn
  std::vector<std::size_t> rotors;
  double frame_drag;  ///< parasitic drag of chapter 2 on the airframe [N s^2/m^2]
  std::array<double, AirframeRow::count> airframe;  ///< AirframeRow
  bool has_airframe;                                ///< whether any of these is not 0

  /// Return the laws for evaluation in steps. They point into this object, and to no fractions.
  RotorForces summed() const { return law(summed_); }
  /// The same forces, law by law.
  RotorForces separate() const { return law(separate_); }

 private:
  Config(const Parameters& p, std::size_t rotor_count, const Given& given)
      : sim_slow(p.number("sim_slow")),
        appendix(given.appendix),
        on_rotor(reacts_on_rotor(p)),
        rotors(p.joints("rotorJoints")),
        frame_drag(appendix ? 0 : laws::ParasiticDrag<double>::coefficient(given)),
        airframe(read_airframe(given)),
        has_airframe(
            std::any_of(airframe.begin(), airframe.end(), [](double k) { return k != 0; })),
        separate_(rotor_count),
        summed_(rotor_count) {
    const std::vector<double> factors = read_factors(p);
    for (std::size_t j = 0; j < rotors.size(); ++j) {
      Given of_rotor = given;
      of_rotor.factor = factors[j];
      separate_.put(rotors[j], RotorLaws::from(of_rotor));
      summed_.put(rotors[j], RotorLaws::with_one_drag(RotorLaws::from(of_rotor)));
    }
  }

  /// Only the drag depends on the density of the air.
  static std::array<double, AirframeRow::count> read_airframe(const Given& given) {
    std::array<double, AirframeRow::count> k = given.numbers(laws::Airframe::tags);
    for (std::size_t row = 0; row < AirframeRow::torque; ++row) k[row] *= given.density_ratio;
    return k;
  }

  /// Return the factor of each rotor of the plugin.
  std::vector<double> read_factors(const Parameters& p) const {
    const std::vector<double>& factors = p.numbers("rotorFactors");
    if (factors.empty()) return std::vector<double>(rotors.size(), 1);
    if (factors.size() != rotors.size()) {
      throw InputError("<rotorFactors> has " + std::to_string(factors.size()) +
                       " numbers, but the plugin has " + std::to_string(rotors.size()) +
                       " rotors. Write one number for each rotor.");
    }
    return factors;
  }

  static bool reacts_on_rotor(const Parameters& p) { return p.choice("reactionOn") == "rotor"; }

  static Given read(const Parameters& p, const Atmosphere& air) {
    const bool as_in_thesis = p.choice("reactionTorque") == "thesis";
    if (reacts_on_rotor(p) && as_in_thesis && p.is_set("reactionTorque")) {
      throw InputError(
          "<reactionOn> rotor requires a reaction torque that opposes the spin, but "
          "<reactionTorque> is thesis. Write opposing, or remove it.");
    }
    return {p, p.has("airDensity") ? air.density() / p.number("airDensity") : 1,
            as_in_thesis && !reacts_on_rotor(p) ? 1.0 : -1.0, p.choice("dragModel") == "appendix"};
  }

  /// In chapter 2, the disc is perpendicular to the joint's axis and wind acts on it. In appendix
  /// A.5, it is perpendicular to the propeller link's z, there is no wind, and the reaction acts on
  /// the frame about its own z. If the reaction acts on a rotor, the joint transmits it to the
  /// frame, and the load on the frame is removed, so that the aerodynamic torque acts on the
  /// vehicle only once.
  RotorForces law(const RotorTable& table) const {
    RotorForces law;
    law.conventions.across_link_z = appendix;
    law.conventions.at_origins = appendix;
    law.conventions.meets_wind = !appendix;
    law.conventions.about_frame_z = appendix && !on_rotor;
    law.conventions.on_rotor = on_rotor;
    law.acting = table.acting;
    law.sim_slow = sim_slow;
    law.coefficients = table.coefficients.data();
    law.shares = nullptr;
    return law;
  }

  RotorTable separate_, summed_;
};

}  // namespace quadcore::aerodynamic
