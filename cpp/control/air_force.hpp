#pragma once

#include <cstddef>

#include "lanes/vec3.hpp"

namespace quadcore::control {

/// The parts of AirResistance that the force depends on, as plain numbers or packs.
template <class N>
struct AirNumbers {
  N linear[9];      ///< AirResistance::linear of force and velocity, by columns
  N components[3];  ///< AirResistance::of_components
  N quadratic;      ///< AirResistance::quadratic
};

/// Return the aerodynamic force in F for a velocity of the centre of mass in F [N].
template <class N, class T>
QUADCORE_LAW laws::Vec3<T> air_force_F(const AirNumbers<N>& air, const laws::Matrix3<T>& R_WF,
                                       const laws::Vec3<T>& v_F) {
  const laws::Vec3<T> v_W = R_WF * v_F;
  const N *l = air.linear, *c = air.components;
  const auto row = [&](std::size_t i) QUADCORE_INLINED {
    return l[i] * v_F.x + (l[i + 3] * v_F.y + l[i + 6] * v_F.z);
  };
  const laws::Vec3<T> f_F{-row(0) - c[0] * laws::absolute(v_W.x) * v_W.x,
                          -row(1) - c[1] * laws::absolute(v_W.y) * v_W.y,
                          -row(2) - c[2] * laws::absolute(v_W.z) * v_W.z};
  if (!laws::any(air.quadratic != 0.0)) return f_F;
  return f_F - (air.quadratic * laws::square_root(dot(v_F, v_F))) * v_F;
}

}  // namespace quadcore::control
