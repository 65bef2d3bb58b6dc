#pragma once

#include <vector>

#include "quadcore/error.hpp"
#include "quadcore/force_laws.hpp"
#include "quadcore/rotor_rows.hpp"
#include "quadcore/tags.hpp"
#include "quadcore/world.hpp"

namespace quadcore::aerodynamic {

/// What the tags say, as the force laws take it.
struct Config {
  double sim_slow, parasitic;
  bool appendix;  ///< dragModel
  bool on_rotor;  ///< reactionOn
  Flapping flapping;
  std::vector<std::size_t> rotors;
  RotorRows<CoefficientRow::count> coefficients;  ///< 0 for the rotors of others

  Config(const Parameters& p, std::size_t rotor_count, const Atmosphere& air)
      : sim_slow(p.number("sim_slow")),
        parasitic(p.number("parasiticDragCoeff")),
        appendix(p.choice("dragModel") == "appendix"),
        flapping{p.number("flappingA1c"), p.number("flappingA1s"), p.number("flappingB1"),
                 p.number("flappingB2"), p.number("rotorRadius")},
        rotors(p.joints("rotorJoints")),
        coefficients(rotor_count) {
    on_rotor = p.choice("reactionOn") == "rotor";
    const bool as_in_thesis = p.choice("reactionTorque") == "thesis";
    if (on_rotor && as_in_thesis && p.is_set("reactionTorque")) {
      throw InputError(
          "<reactionOn> rotor lets the air brake the rotors, so that <reactionTorque> cannot be "
          "thesis; write opposing, or leave it out");
    }
    const double thinness = p.has("airDensity") ? air.density() / p.number("airDensity") : 1;
    parasitic *= thinness;
    const double reaction_sign = as_in_thesis && !on_rotor ? 1 : -1;
    for (const std::size_t i : rotors) {
      const auto coefficient = [&](std::size_t row) -> double& {
        return coefficients.number(row, i);
      };
      using Row = CoefficientRow;
      coefficient(Row::k) = thinness * p.number("rotorThrustCoeff");
      coefficient(Row::b) = thinness * reaction_sign * p.number("rotorTorqueCoeff");
      coefficient(Row::induced) = thinness * p.number("inducedDragCoeff");
      coefficient(Row::translational) = thinness * p.number("translationalDragCoeff");
      coefficient(Row::profile) = thinness * p.number("profileDragCoeff");
      coefficient(Row::linear) =
          coefficient(Row::induced) + coefficient(Row::translational) + coefficient(Row::profile);
      coefficient(Row::parasitic) = parasitic;
    }
  }

  /// Chapter 2: the disc stands across the joint's axis and meets the moving air. Appendix A.5: it
  /// stands across the propeller link's z, the air is still everywhere, and the reaction turns the
  /// frame about its own z. On a rotor, whose joint hands it to the frame, the reaction takes that
  /// back, so that the air's torque is on the vehicle once. Points into this.
  RotorForces law() const {
    RotorForces law;
    law.coefficients = coefficients.data();
    law.across_link_z = appendix;
    law.at_origins = appendix;
    law.meets_wind = !appendix;
    law.about_frame_z = appendix && !on_rotor;
    law.on_rotor = on_rotor;
    law.parasitic = appendix && parasitic != 0;
    law.flaps = flapping.A1c != 0 || flapping.A1s != 0 || flapping.B1 != 0 || flapping.B2 != 0;
    law.flapping = flapping;
    law.sim_slow = sim_slow;
    return law;
  }
};

}  // namespace quadcore::aerodynamic
