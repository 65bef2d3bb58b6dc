#pragma once

#include <ode/ode.h>

#include "quadcore/plugin/spatial.hpp"

namespace quadcore {

/// Size of a body's pose in ODE: position 3, quaternion 4, rotation matrix 3 x 4.
constexpr int pose_size = 19;
/// Size of a body's velocity: linear 3, angular 3.
constexpr int velocity_size = 6;

/// \name Copies of a body's state, bit for bit
/// ODE renormalises a quaternion that is set through its interface, which changes its last digits;
/// restoring therefore writes to the body's own arrays.
/// @{
void save_pose(dBodyID body, double* to);
void restore_pose(dBodyID body, const double* from);
void save_velocity(dBodyID body, double* to);
void restore_velocity(dBodyID body, const double* from);
/// @}

/// Move a body's pose like ODE's step: position + dt v, and the quaternion q to q + dt/2 w q,
/// normalised.
void move_pose(dBodyID body, const Vector3d& v_W, const Vector3d& w_W, double dt);

/// Discard the forces and torques added since the last step. A completed step does this, a failed
/// one does not.
void forget_forces(dBodyID body);

}  // namespace quadcore
