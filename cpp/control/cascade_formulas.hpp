#pragma once

#include "attitude_formulas.hpp"
#include "controller_numbers.hpp"
#include "euler_formulas.hpp"

/// \file
/// The cascaded control law as formulas for numbers or packs. Contains neither Eigen nor code, so
/// that files compiled for a specific processor can include it.

namespace quadcore::control {

/// Gains of Cascade by axes, and the modelled vehicle.
template <class T>
struct CascadeNumbers {
  Vec3<T> position_p, position_i, position_d;
  Vec3<T> angle_p, angle_i, angle_d;
  VehicleNumbers<T> vehicle;
};

/// Memory of the cascaded control law: integrals of the position and angle errors.
template <class T>
struct CascadeMemory {
  Vec3<T> position, angles;
};

/// Parts of the cascaded control law, see Cascade.
template <class T>
struct CascadeFormulas {
  const ControllerSwitches& switches;
  const CascadeNumbers<T>& gains;
  const InputNumbers<T>& input;

  /// Return the acceleration of (2.43), with an integral as in section 6.2, in W [m/s^2].
  QUADCORE_LAW Vec3<T> acceleration(Vec3<T>& integral) const {
    const WantedNumbers<T>& wanted = input.wanted;
    const Vec3<T> error = wanted.position - input.now.position;
    integral = integral + input.period * error;
    const Vec3<T> a_W = by_components(gains.position_p, error) +
                        by_components(gains.position_i, integral) +
                        by_components(gains.position_d, wanted.velocity - input.now.v_WF_W);
    return switches.feed_forward ? a_W + wanted.acceleration : a_W;
  }

  /// Return U* + g e3 of (2.56), the required force of the rotors per mass, in W [m/s^2].
  QUADCORE_LAW Vec3<T> lift_W(const Matrix3<T>& R_WF, const Vec3<T>& a_WF_W) const {
    const VehicleNumbers<T>& vehicle = gains.vehicle;
    const MeasuredNumbers<T>& now = input.now;
    Vec3<T> a_W = a_WF_W + Vec3<T>{T{}, T{}, vehicle.gravity};
    if (switches.flat_rates) a_W = a_W + input.wanted.a_FCcm_W;
    if (!switches.drag) return a_W;
    const Vec3<T> v_F = v_WCcm_F(vehicle, laws::inversely(R_WF, now.v_WF_W), now.w_WF_F);
    const Vec3<T> f_W = R_WF * air_force_F(vehicle.air, R_WF, v_F);
    return a_W - Vec3<T>{f_W.x / vehicle.mass, f_W.y / vehicle.mass, f_W.z / vehicle.mass};
  }

  /// Return how far roll, pitch and yaw are from those of (2.46), (2.47) or (2.53), (2.54), with
  /// the measured yaw [rad]. The wanted pitch is that of the whole turn, which makes a demand
  /// beyond free fall turn the vehicle over instead of reversing the demand. Without a demand, a
  /// level vehicle is wanted.
  QUADCORE_LAW Vec3<T> angle_errors(const EulerAngles<T>& now, const Vec3<T>& lift_W) const {
    const T ahead = lift_W.x * now.yaw.cos + lift_W.y * now.yaw.sin,
            right = lift_W.x * now.yaw.sin - lift_W.y * now.yaw.cos;
    const T up = laws::chosen_by(dot(lift_W, lift_W) == 0.0, laws::broadcast<T>(1), lift_W.z);
    const T without_roll = laws::square_root(ahead * ahead + up * up);
    const Vec3<T>& across_W = input.wanted.across_W;
    return {angle_between(now.roll, {right, without_roll}), angle_between(now.pitch, {ahead, up}),
            angle_between(now.yaw, {-across_W.x, across_W.y})};
  }

  /// Return the angular acceleration of (2.50), with integrals as in section 6.2, in F [rad/s^2].
  /// J(eta) y + C(eta, eta') eta' are generalised torques, W^T times those about the body axes.
  /// With J = W^T I W, the latter are I (W y + W' eta') + w x I w.
  QUADCORE_LAW Vec3<T> angular_acceleration(const EulerAngles<T>& now, const Vec3<T>& error,
                                            Vec3<T>& integral) const {
    const Vec3<T> rates = now.by_inverse_W(input.now.w_WF_F);
    integral = integral + input.period * error;
    const Vec3<T> of_errors =
        by_components(gains.angle_p, error) + by_components(gains.angle_i, integral);
    const auto y = [&](const Vec3<T>& wanted_rates) QUADCORE_INLINED {
      return of_errors + by_components(gains.angle_d, wanted_rates - rates);
    };
    if (!switches.flat_rates) {
      // The yaw rate comes from the reference.
      return now.by_W(y({T{}, T{}, input.wanted.yaw_rate})) + now.by_dW(rates);
    }
    // W eta'' = w' - W' eta'.
    const Matrix3<T>& R_WF = input.wanted.R_WF;
    const EulerAngles<T> flat(R_WF);
    const Vec3<T> flat_rates = flat.by_inverse_W(laws::inversely(R_WF, input.wanted.w_WF_W));
    const Vec3<T> flat_accelerations =
        flat.by_inverse_W(laws::inversely(R_WF, input.wanted.dw_WF_W) - flat.by_dW(flat_rates));
    return now.by_W(y(flat_rates) + flat_accelerations) + now.by_dW(rates);
  }
};

/// See Cascade.
template <class T>
QUADCORE_LAW DemandNumbers<T> demand_by_cascade(const CascadeFormulas<T>& formulas,
                                                CascadeMemory<T>& memory) {
  const VehicleNumbers<T>& vehicle = formulas.gains.vehicle;
  const MeasuredNumbers<T>& now = formulas.input.now;
  const Matrix3<T> R_WF = laws::rotation(now.q_WF);
  const EulerAngles<T> angles(R_WF);
  const Vec3<T> lift_W = formulas.lift_W(R_WF, formulas.acceleration(memory.position));
  const Vec3<T> dw_WF_F =
      formulas.angular_acceleration(angles, formulas.angle_errors(angles, lift_W), memory.angles);
  // (2.48) or (2.55), and (2.49) or (2.57).
  return {vehicle.mass * dot(lift_W, Vec3<T>{R_WF.xz, R_WF.yz, R_WF.zz}),
          attitude_torque(vehicle, formulas.switches.drag, formulas.switches.gyroscopic, R_WF,
                          now.v_WF_W, now.w_WF_F, formulas.input.rotors.h_F, dw_WF_F)};
}

}  // namespace quadcore::control
