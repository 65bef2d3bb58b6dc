#pragma once

#include "../vehicle.hpp"
#include "quadcore/control/modelled_vehicle.hpp"

/// \file
/// Vehicles that controllers believe in, none with a symmetry that would hide a slip.

namespace quadcore::test {

/// n rotors in an irregular ring, tilted a little, alternating; the centre of mass is off the
/// origin.
inline control::ModelledVehicle odd_belief(int n, double fastest = 900) {
  control::ModelledVehicle model;
  model.mass = 1.3;
  model.p_FCcm_F = {0.01, -0.02, 0.03};
  model.inertia_Ccm_F << 0.011, 4e-4, -3e-4, 4e-4, 0.014, 2e-4, -3e-4, 2e-4, 0.021;
  model.gravity = 9.7;
  model.effectiveness.resize(6, n);
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * M_PI * i / n + 0.1 * i * (n - i) / n, spin = i % 2 == 0 ? 1 : -1;
    const Vector3d p(0.2 * std::cos(angle) + 0.01, (0.22 + 0.01 * i) * std::sin(angle), 0.02);
    const Vector3d axis = Vector3d(0.03 * i, -0.05, 1).normalized();
    const double k = 1.1e-5 + 3e-7 * i;
    model.rotors.push_back({axis, spin, 2.8e-5, 0.05, 0, fastest});
    const Vector3d force = k * axis;
    model.effectiveness.col(i) << force, (p - model.p_FCcm_F).cross(force) + spin * 2e-7 * axis;
  }
  return model;
}

}  // namespace quadcore::test
