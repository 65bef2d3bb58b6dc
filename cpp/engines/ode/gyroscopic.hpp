#pragma once

#include <ode/ode.h>

#include <vector>

#include "quadcore/model.hpp"
#include "quadcore/spatial.hpp"

/// \file
/// The torque -w x (I w) that makes a tumbling body keep its angular momentum, as the two ODE
/// engines apply it. Upstream ODE's own (implicit) term is off on every body.

namespace quadcore {

/// One body as the gyroscopic laws need it; links[0] is the frame.
struct GyroscopicBody {
  dBodyID body;
  std::size_t parent;  ///< index of the parent body; itself for the frame
  Vector3d axis_B;     ///< joint axis in the body's axes; zero for the frame
  Matrix3d I_Bcm_B;    ///< inertia about the centre of mass in the body's axes [kg m^2]
};

/// Gazebo 11's: -w x (I w) of each body with its own rate w, explicitly, on that body. On a
/// spinning propeller whose hinge ties it to the frame this acts as a damper on roll and pitch, at
/// a rate of about 4 (Izz - Ixx) W^2 dt / (2 Jx) for four propellers: the published model's fault.
void add_gyroscopic_per_body(const std::vector<GyroscopicBody>& bodies);

/// The right one: the gyroscopic torque of a propeller follows from its carrier's rate w_F and the
/// joint rate W, w = w_F + W a, and what stands across the axis acts on the carrier. For an
/// axisymmetric propeller this is -w_F x (I_P w_F + (Izz - Ixx) W a); the remaining Ixx W (w_F x a)
/// comes out of the hinge rows because the relative velocity turns with the axis.
void add_gyroscopic_from_carrier(const std::vector<GyroscopicBody>& bodies);

}  // namespace quadcore
