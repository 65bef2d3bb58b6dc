#pragma once

#include "measured_numbers.hpp"
#include "vehicle_numbers.hpp"

/// \file
/// Input and demand of a control law as plain numbers or packs, see ControllerInput. Contains
/// neither Eigen nor code, so that files compiled for a specific processor can include it.

namespace quadcore::control {

/// The reference, and the flat state of control laws that use it.
template <class T>
struct WantedNumbers {
  Vec3<T> position, velocity, acceleration;
  Vec3<T> across_W;  ///< across_yaw()
  Matrix3<T> R_WF;
  Vec3<T> w_WF_W, dw_WF_W;  ///< in W, because control laws use them in the measured F
  Vec3<T> a_FCcm_W;
  T thrust;
  T yaw_rate;
};

/// A demand on the rotors.
template <class T>
struct DemandNumbers {
  T thrust;
  Vec3<T> torque_F;
};

/// Modelled state of the rotors.
template <class T>
struct RotorsNumbers {
  DemandNumbers<T> exerted;
  Vec3<T> h_F;
  T saturated;  ///< 1 if the last demand was not met, else 0
};

/// Switches of control laws; each has a part of them.
struct ControllerSwitches {
  bool feed_forward, flat_rates, integral, drag, gyroscopic;
};

/// Input of a control law.
template <class T>
struct InputNumbers {
  double period;
  bool begins;
  const MeasuredNumbers<T>& now;
  const WantedNumbers<T>& wanted;
  const RotorsNumbers<T>& rotors;

  /// Return the integral of an error after the period. Demands that the rotors cannot follow, and
  /// those beyond a limit, do not increase it.
  /// \param gain, limit  gain of the integral, and the maximum of their product
  QUADCORE_LAW T integrated(T integral, T error, T gain, T limit) const {
    const T sum = integral + period * error;
    const auto grows = laws::absolute(sum) > laws::absolute(integral);
    const auto acts = (gain * laws::absolute(sum) <= limit) & (rotors.saturated == 0);
    return laws::chosen_by(grows, laws::chosen_by(acts, sum, integral), sum);
  }
};

}  // namespace quadcore::control
