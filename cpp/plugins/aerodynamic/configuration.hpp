#pragma once

#include <array>
#include <cstring>
#include <vector>

#include "laws/rotor_forces.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/rotor_rows.hpp"
#include "quadcore/plugin/tags.hpp"
#include "quadcore/plugin/world.hpp"

namespace quadcore::aerodynamic {

using laws::RotorLaws;

/// What the laws take their coefficients from.
struct Given {
  const Parameters& parameters;
  double density_ratio;  ///< of the air, to that for which the coefficients are
  double reaction_sign;  ///< 1 for a reaction torque with the spin, -1 against it
  bool appendix;         ///< dragModel

  /// The numbers of a law's tags.
  template <std::size_t n>
  std::array<double, n> numbers(const laws::Tag (&tags)[n]) const {
    std::array<double, n> numbers;
    for (std::size_t i = 0; i < n; ++i) numbers[i] = parameters.number(tags[i].name);
    return numbers;
  }
};

/// The laws of all rotors, which do not act on the rotors of others.
struct RotorTable {
  RotorLaws::Places acting;
  RotorRows<RotorLaws::rows> coefficients;

  RotorTable(const RotorLaws::Coefficients<double>& of_each, const std::vector<std::size_t>& rotors,
             std::size_t rotor_count)
      : acting(RotorLaws::acting(of_each)), coefficients(rotor_count) {
    double numbers[RotorLaws::rows];
    std::memcpy(numbers, &of_each, sizeof numbers);
    for (const std::size_t i : rotors) {
      for (std::size_t row = 0; row < RotorLaws::rows; ++row) {
        coefficients.number(row, i) = numbers[row];
      }
    }
  }
};

/// What the tags say, as the force laws take it.
class Config {
 public:
  Config(const Parameters& p, std::size_t rotor_count, const Atmosphere& air)
      : Config(p, rotor_count, read(p, air)) {}

  double sim_slow;
  bool appendix;  ///< dragModel
  bool on_rotor;  ///< reactionOn
  std::vector<std::size_t> rotors;
  double frame_drag;  ///< of chapter 2, on the airframe [N s^2/m^2]

  /// The laws as steps evaluate them. Points into this, and to no shares.
  RotorForces summed() const { return law(summed_); }
  /// The same forces law by law.
  RotorForces separate() const { return law(separate_); }

 private:
  Config(const Parameters& p, std::size_t rotor_count, const Given& given)
      : sim_slow(p.number("sim_slow")),
        appendix(given.appendix),
        on_rotor(reacts_on_rotor(p)),
        rotors(p.joints("rotorJoints")),
        frame_drag(appendix ? 0 : laws::ParasiticDrag<double>::coefficient(given)),
        separate_(RotorLaws::from(given), rotors, rotor_count),
        summed_(RotorLaws::with_one_drag(RotorLaws::from(given)), rotors, rotor_count) {}

  static bool reacts_on_rotor(const Parameters& p) { return p.choice("reactionOn") == "rotor"; }

  static Given read(const Parameters& p, const Atmosphere& air) {
    const bool as_in_thesis = p.choice("reactionTorque") == "thesis";
    if (reacts_on_rotor(p) && as_in_thesis && p.is_set("reactionTorque")) {
      throw InputError(
          "<reactionOn> rotor lets the air brake the rotors, so that <reactionTorque> cannot be "
          "thesis; write opposing, or leave it out");
    }
    return {p, p.has("airDensity") ? air.density() / p.number("airDensity") : 1,
            as_in_thesis && !reacts_on_rotor(p) ? 1.0 : -1.0, p.choice("dragModel") == "appendix"};
  }

  /// Chapter 2: the disc stands across the joint's axis and meets the moving air. Appendix A.5: it
  /// stands across the propeller link's z, the air is still everywhere, and the reaction turns the
  /// frame about its own z. On a rotor, whose joint hands it to the frame, the reaction takes that
  /// back, so that the air's torque is on the vehicle once.
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
