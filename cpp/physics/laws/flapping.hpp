#pragma once

#include "thrust.hpp"

namespace quadcore::laws {

/// Blade flapping, thesis eq. (2.25) as corrected: F = T/|w| (A V_p + B nu) at the rotor's centre
/// of mass, in the body's non-spinning axes, with T/|w| = k |w|, nu the frame's angular velocity,
/// s = sign(w) and
///   A = 1/r [-A1c  s A1s; -s A1s  -A1c],   B = [-s B2  B1; -B1  -s B2].
/// Both matrices commute with a turn about the axis a, so that A V = (-A1c V - s A1s a x V)/r and
/// B nu = -s B2 nu - B1 a x nu for the in-plane V and nu: no axes need to be chosen.
template <class T>
struct Flapping {
  T k;           ///< thrust coefficient [N s^2/rad^2]
  T A1c, A1s;    ///< rad
  T B1, B2;      ///< s/rad
  T per_radius;  ///< 1/r [1/m]

  static constexpr const char* term = "flapping";
  static constexpr Effect effect = Effect::force;
  static constexpr Tag tags[] = {
      {"flappingA1c", "rad", "0", "longitudinal blade flapping; positive opposes the motion",
       "(2.26)", Tag::Scales::drag},
      {"flappingA1s", "rad", "0", "lateral blade flapping", "(2.26)", Tag::Scales::drag},
      {"flappingB1", "s/rad", "0", "blade flapping by the frame's rates, cross term", "(2.27)",
       Tag::Scales::drag},
      {"flappingB2", "s/rad", "0", "blade flapping by the frame's rates, direct term", "(2.27)",
       Tag::Scales::drag},
      {"rotorRadius", "m", "0.075", "rotor radius, for blade flapping", "(2.26)", Tag::Scales::none,
       Tag::above_zero},
  };
  template <class Given>
  static Flapping from(const Given& given) {
    const auto [A1c, A1s, B1, B2, radius] = given.numbers(tags);
    if (A1c == 0 && A1s == 0 && B1 == 0 && B2 == 0) return {};
    return {Thrust<T>::from(given).k, A1c, A1s, B1, B2, 1 / radius};
  }

  template <class Motion>
  QUADCORE_LAW Vec3<T> force(const RotorDisc<T>& disc, const Motion& motion) const {
    const T s = with_sign_of(disc.speed, broadcast<T>(1));
    const Vec3<T> nu_F = across(disc.axis_F, motion.w_WF_F());
    const Vec3<T> A_V_r = -A1c * disc.V_F - (s * A1s) * cross(disc.axis_F, disc.V_F);
    const Vec3<T> B_nu = (-s * B2) * nu_F - B1 * cross(disc.axis_F, nu_F);
    return (disc.share * k * absolute(disc.speed)) * (per_radius * A_V_r + B_nu);
  }
};

}  // namespace quadcore::laws
