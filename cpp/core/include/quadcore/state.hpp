#pragma once

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// State of a vehicle with one frame and n rotors, for logs and bindings.
struct VehicleState {
  double time = 0;                       ///< s
  Vector3d position = Vector3d::Zero();  ///< p_WF: position of the frame's origin in the world [m]
  Quaterniond orientation = Quaterniond::Identity();  ///< orientation of F in W, unit quaternion
  Vector3d linear_velocity = Vector3d::Zero();   ///< v_WF_W: velocity of the frame's origin [m/s]
  Vector3d angular_velocity = Vector3d::Zero();  ///< w_WF_F: angular velocity in body axes [rad/s]
  VectorXd rotor_velocity;                       ///< (n,) joint rates [rad/s]
  VectorXd rotor_angle;                          ///< (n,) joint angles in (-pi, pi] [rad]
};

}  // namespace quadcore
