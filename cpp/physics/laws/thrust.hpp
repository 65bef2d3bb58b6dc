#pragma once

#include "rotor_law.hpp"

namespace quadcore::laws {

/// Thrust, thesis eq. (2.10): T = k w^2 along the disc's normal, at the rotor's centre of mass.
template <class T>
struct Thrust {
  T k;  ///< N s^2/rad^2

  static constexpr const char* term = "thrust";
  static constexpr Effect effect = Effect::force;
  static constexpr Tag tags[] = {{"rotorThrustCoeff", "N s^2/rad^2", required,
                                  "thrust coefficient of a rotor, k: thrust per squared speed",
                                  "(2.10)", Tag::Scales::thrust, Tag::at_least_zero}};
  template <class Given>
  static Thrust from(const Given& given) {
    const auto [k] = given.numbers(tags);
    return {given.density_ratio * given.factor * k};
  }

  template <class Motion>
  QUADCORE_LAW Vec3<T> force(const RotorDisc<T>& disc, const Motion&) const {
    return (disc.share * k * disc.speed * disc.speed) * disc.axis_F;
  }
};

/// Reaction torque, thesis eq. (2.11) without its inertial part, which the engine models: b w^2
/// with the sign of the spin, as in the thesis. The physical sign is the opposite (b < 0).
template <class T>
struct Reaction {
  T b;  ///< N m s^2/rad^2, negative for the opposing sign

  static constexpr const char* term = "reaction";
  static constexpr Effect effect = Effect::reaction_torque;
  static constexpr Tag tags[] = {
      {"rotorTorqueCoeff", "N m s^2/rad^2", required,
       "torque coefficient of a rotor, b: reaction torque per squared speed", "(2.11)",
       Tag::Scales::thrust, Tag::at_least_zero}};
  template <class Given>
  static Reaction from(const Given& given) {
    const auto [b] = given.numbers(tags);
    return {given.density_ratio * given.reaction_sign * given.factor * b};
  }

  QUADCORE_LAW T torque(const RotorDisc<T>& disc) const {
    return disc.share * b * disc.speed * absolute(disc.speed);
  }
};

}  // namespace quadcore::laws
