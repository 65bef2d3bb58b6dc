#pragma once

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// The state of a vehicle of one frame and n rotors, as logs and bindings show it.
struct VehicleState {
  double time = 0;                                    ///< s
  Vector3d position = Vector3d::Zero();               ///< p_WF: frame origin in the world [m]
  Quaterniond orientation = Quaterniond::Identity();  ///< of F in W, unit
  Vector3d linear_velocity = Vector3d::Zero();        ///< v_WF_W: of the frame origin [m/s]
  Vector3d angular_velocity = Vector3d::Zero();       ///< w_WF_F: in body axes [rad/s]
  VectorXd rotor_velocity;                            ///< (n,) joint rates [rad/s]
  VectorXd rotor_angle;                               ///< (n,) joint angles in (-pi, pi] [rad]
};

}  // namespace quadcore
