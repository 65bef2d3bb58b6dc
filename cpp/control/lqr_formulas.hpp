#pragma once

#include "attitude_formulas.hpp"
#include "controller_numbers.hpp"

/// \file
/// The linear-quadratic control law as formulas for numbers or packs. Contains neither Eigen nor
/// code, so that files compiled for a specific processor can include it.

namespace quadcore::control {

/// Optimal gains, see Lqr, and the modelled vehicle.
template <class T>
struct LqrNumbers {
  T level[5];   ///< gains of integral, position, velocity, tilt and rate
  T height[3];  ///< gains of integral, position and velocity
  T yaw[2];     ///< gains of yaw and its rate
  T sum_limit;
  VehicleNumbers<T> vehicle;
};

/// Memory of the linear-quadratic control law.
template <class T>
struct LqrMemory {
  Vec3<T> integral;
};

/// See Lqr.
template <class T>
QUADCORE_LAW DemandNumbers<T> demand_optimally(const ControllerSwitches& switches,
                                               const LqrNumbers<T>& gains,
                                               const InputNumbers<T>& input, LqrMemory<T>& memory) {
  const MeasuredNumbers<T>& now = input.now;
  const WantedNumbers<T>& wanted = input.wanted;
  const Vec3<T> error_W = wanted.position - now.position;
  const auto grow = [&](T& sum, T error) QUADCORE_INLINED {
    sum = input.integrated(sum, error, laws::broadcast<T>(1), gains.sum_limit);
  };
  grow(memory.integral.x, error_W.x);
  grow(memory.integral.y, error_W.y);
  grow(memory.integral.z, error_W.z);

  // In the axes D of the flat state, around which the vehicle is linearised.
  const Vec3<T> sum_D = laws::inversely(wanted.R_WF, memory.integral),
                error_D = laws::inversely(wanted.R_WF, error_W),
                slip_D = laws::inversely(wanted.R_WF, wanted.velocity - now.v_WF_W);
  const Matrix3<T> R_WF = laws::rotation(now.q_WF), R_FD = inversely(R_WF, wanted.R_WF);
  const Vec3<T> turn_F = attitude_error(quaternion_of(R_FD));
  const Vec3<T> wanted_w_F =
      (switches.flat_rates ? 1.0 : 0.0) * laws::inversely(R_WF, wanted.w_WF_W);
  const Vec3<T> slip_w_F = wanted_w_F - now.w_WF_F;

  const auto level = [&](T sum, T error, T slip, T tilt, T rate) QUADCORE_INLINED {
    return gains.level[0] * sum + gains.level[1] * error + gains.level[2] * slip +
           gains.level[3] * tilt + gains.level[4] * rate;
  };
  // Positive pitch accelerates along x, positive roll along -y.
  Vec3<T> dw_F{-level(sum_D.y, error_D.y, slip_D.y, -turn_F.x, -slip_w_F.x),
               level(sum_D.x, error_D.x, slip_D.x, turn_F.y, slip_w_F.y),
               gains.yaw[0] * turn_F.z + gains.yaw[1] * slip_w_F.z};
  if (switches.flat_rates) {
    dw_F = dw_F + (laws::inversely(R_WF, wanted.dw_WF_W) - cross(now.w_WF_F, wanted_w_F));
  }
  const T climb =
      gains.height[0] * sum_D.z + (gains.height[1] * error_D.z + gains.height[2] * slip_D.z);
  return {wanted.thrust + gains.vehicle.mass * climb,
          attitude_torque(gains.vehicle, switches.drag, switches.gyroscopic, R_WF, now.v_WF_W,
                          now.w_WF_F, input.rotors.h_F, dw_F)};
}

}  // namespace quadcore::control
