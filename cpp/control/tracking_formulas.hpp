#pragma once

#include "attitude_formulas.hpp"
#include "controller_numbers.hpp"

/// \file
/// The control laws on SE(3) as formulas for numbers or packs. Contains neither Eigen nor code, so
/// that files compiled for a specific processor can include it.

namespace quadcore::control {

/// Gains of TrackingGains by axes, and the modelled vehicle.
template <class T>
struct TrackingNumbers {
  Vec3<T> position_p, position_i, position_d;
  T integral_limit;
  AttitudeNumbers<T> attitude;
  VehicleNumbers<T> vehicle;
};

/// Common parts of the control laws on SE(3).
template <class T>
struct TrackingFormulas {
  const ControllerSwitches& switches;
  const TrackingNumbers<T>& gains;
  const InputNumbers<T>& input;
  Matrix3<T> R_WF = laws::rotation(input.now.q_WF);  ///< measured orientation

  /// Return the acceleration that corrects position and velocity errors, in W [m/s^2].
  /// \param integral  memory [m s]
  QUADCORE_LAW Vec3<T> acceleration(Vec3<T>& integral) const {
    const Vec3<T> error = input.wanted.position - input.now.position;
    Vec3<T> a_W = by_components(gains.position_p, error) +
                  by_components(gains.position_d, input.wanted.velocity - input.now.v_WF_W);
    if (switches.feed_forward) a_W = a_W + input.wanted.acceleration;
    if (!switches.integral) return a_W;
    const auto grow = [&](T& sum, T error, T gain) QUADCORE_INLINED {
      sum = input.integrated(sum, error, gain, gains.integral_limit);
    };
    grow(integral.x, error.x, gains.position_i.x);
    grow(integral.y, error.y, gains.position_i.y);
    grow(integral.z, error.z, gains.position_i.z);
    return a_W + by_components(gains.position_i, integral);
  }

  /// Return the force of the rotors for an acceleration of the origin of F, in F [N].
  QUADCORE_LAW Vec3<T> force_F(const Vec3<T>& a_WF_W) const {
    const VehicleNumbers<T>& vehicle = gains.vehicle;
    Vec3<T> other_W{T{}, T{}, vehicle.gravity};
    if (switches.flat_rates) other_W = other_W + input.wanted.a_FCcm_W;
    const Vec3<T> f_F = vehicle.mass * laws::inversely(R_WF, a_WF_W + other_W);
    if (!switches.drag) return f_F;
    const MeasuredNumbers<T>& now = input.now;
    const Vec3<T> v_F = v_WCcm_F(vehicle, laws::inversely(R_WF, now.v_WF_W), now.w_WF_F);
    return f_F - air_force_F(vehicle.air, R_WF, v_F);
  }

  /// Return the angular acceleration that rotates z of F to a direction in F and x to the yaw, in F
  /// [rad/s^2].
  QUADCORE_LAW Vec3<T> angular_acceleration(const Vec3<T>& direction_F) const {
    const Vec3<T> across_F = laws::inversely(R_WF, input.wanted.across_W);
    const Quaternion<T> q_FD = quaternion_of(attitude_of(direction_F, across_F));
    const Vec3<T>& w_WF_F = input.now.w_WF_F;
    if (!switches.flat_rates) {
      const Vec3<T> w_error_F{-w_WF_F.x, -w_WF_F.y, -w_WF_F.z};
      return control::angular_acceleration(gains.attitude, q_FD, w_error_F);
    }
    const Vec3<T> wanted_w_F = laws::inversely(R_WF, input.wanted.w_WF_W);
    const Vec3<T> wanted_dw_F =
        laws::inversely(R_WF, input.wanted.dw_WF_W) - cross(w_WF_F, wanted_w_F);
    return control::angular_acceleration(gains.attitude, q_FD, wanted_w_F - w_WF_F) + wanted_dw_F;
  }

  /// Return the torque of the rotors for an angular acceleration, in F [N m].
  QUADCORE_LAW Vec3<T> torque(const Vec3<T>& dw_WF_F) const {
    const MeasuredNumbers<T>& now = input.now;
    return attitude_torque(gains.vehicle, switches.drag, switches.gyroscopic, R_WF, now.v_WF_W,
                           now.w_WF_F, input.rotors.h_F, dw_WF_F);
  }

  /// Return z of F in W.
  QUADCORE_LAW Vec3<T> z_W() const { return {R_WF.xz, R_WF.yz, R_WF.zz}; }
};

/// Memory of the geometric control formulas.
template <class T>
struct GeometricMemory {
  Vec3<T> integral;
};

/// See Geometric.
template <class T>
QUADCORE_LAW DemandNumbers<T> demand_geometrically(const TrackingFormulas<T>& formulas,
                                                   GeometricMemory<T>& memory) {
  const Vec3<T> f_F = formulas.force_F(formulas.acceleration(memory.integral));
  return {f_F.z, formulas.torque(formulas.angular_acceleration(f_F))};
}

/// Memory of the incremental control law: the integral of the position error, then the filtered
/// signals.
template <class T>
struct IndiMemory {
  Vec3<T> integral, velocity, rate, force, torque;
};

/// Numbers of the incremental control formulas.
template <class T>
struct IndiNumbers {
  TrackingNumbers<T> tracking;
  T share;  ///< fraction of a change that the filters pass within the period
};

/// Let a filtered signal follow a signal and return its rate of change.
template <class T>
QUADCORE_LAW Vec3<T> filter(T share, double period, const Vec3<T>& x, Vec3<T>& filtered) {
  const Vec3<T> change = share * (x - filtered);
  filtered = filtered + change;
  return {change.x / period, change.y / period, change.z / period};
}

/// See Indi.
/// \param share  fraction of a change that the filters pass within the period
template <class T>
QUADCORE_LAW DemandNumbers<T> demand_incrementally(const TrackingFormulas<T>& formulas, T share,
                                                   IndiMemory<T>& memory) {
  const InputNumbers<T>& input = formulas.input;
  const VehicleNumbers<T>& vehicle = formulas.gains.vehicle;
  const Vec3<T> z_W = formulas.z_W();
  const Vec3<T> a_W = formulas.acceleration(memory.integral);
  // Start with modelled values, including the accelerations, before the first measurement.
  if (input.begins) {
    const Vec3<T> f_F = formulas.force_F(a_W);
    const Vec3<T> dw_F = formulas.angular_acceleration(f_F);
    const DemandNumbers<T> demand{f_F.z, formulas.torque(dw_F)};
    const T behind = input.period * (1 / share - 1);  // lag of a filter on a ramp
    memory.velocity = input.now.v_WF_W - behind * a_W;
    memory.rate = input.now.w_WF_F - behind * dw_F;
    memory.force = demand.thrust * z_W;
    memory.torque = demand.torque_F;
    return demand;
  }
  // The same filter for all signals, so that the compared values have the same delay.
  const DemandNumbers<T>& exerted = input.rotors.exerted;
  const double period = input.period;
  const Vec3<T> measured_a_W = filter(share, period, input.now.v_WF_W, memory.velocity);
  const Vec3<T> measured_dw_F = filter(share, period, input.now.w_WF_F, memory.rate);
  filter(share, period, exerted.thrust * z_W, memory.force);
  filter(share, period, exerted.torque_F, memory.torque);

  // Both accelerations refer to the origin of F; the force already includes the relative
  // acceleration of the centre of mass.
  const Vec3<T> f_F =
      laws::inversely(formulas.R_WF, memory.force + vehicle.mass * (a_W - measured_a_W));
  const Vec3<T> dw_F = formulas.angular_acceleration(f_F);
  const Vec3<T> incremental_F = memory.torque + vehicle.inertia_Ccm_F * (dw_F - measured_dw_F);
  return {f_F.z, {incremental_F.x, incremental_F.y, formulas.torque(dw_F).z}};
}

}  // namespace quadcore::control
