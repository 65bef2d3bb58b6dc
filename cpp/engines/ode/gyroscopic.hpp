#pragma once

#include <ode/ode.h>

#include <vector>

#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/spatial.hpp"

/// \file
/// The gyroscopic torque -w x (I w), which conserves the angular momentum of a tumbling body, for
/// the two ODE engines. Upstream ODE's own (implicit) term is disabled on every body.

namespace quadcore {

/// Data of one body for the gyroscopic torque.
struct GyroscopicBody {
  dBodyID body;
  std::size_t parent;  ///< index of the parent body; itself for the frame
  Vector3d axis_B;     ///< joint axis in the body's axes; zero for the frame
  Matrix3d I_Bcm_B;    ///< inertia about the centre of mass in the body's axes [kg m^2]
};

/// A body on a hinge at the start of a step, in the axes of its carrier C.
struct HingedBody {
  Vector3d axis_C;
  Matrix3d I_Bcm_C;
  double rate;  ///< rate of the joint [rad/s]

  HingedBody(const GyroscopicBody& b, dBodyID carrier);
};

/// A vehicle's bodies in the order of its model's links: the frame, then one for each joint.
struct GyroscopicVehicle {
  std::vector<GyroscopicBody> bodies;
  std::vector<HingedBody> hinged;  ///< all bodies except the frame, refilled in each step
  /// Inertia of the frame and of the other bodies' masses about the vehicle's centre of mass [kg
  /// m^2].
  Matrix3d I_frame_and_masses_F;
  /// Inverse of the inertia against a torque on the frame with free joints: the whole vehicle's
  /// inertia minus each hinged body's moment about its joint [1/(kg m^2)].
  Matrix3d inverse_reduced_I_F;

  GyroscopicVehicle(const Model& model, const std::vector<dBodyID>& bodies);
};

/// Add Gazebo 11's explicit torque -w x (I w) of each body with its own rate w. On propellers that
/// are hinged to the frame, it damps roll and pitch at a rate of about 4 (Izz - Ixx) W^2 dt / (2
/// Jx) for four propellers. On a tumbling frame it generates energy. These are known errors of the
/// published model.
void add_gyroscopic_per_body(GyroscopicVehicle& vehicle, double dt);

/// Add the correct torque. The gyroscopic torque of a propeller follows from its carrier's rate w_F
/// and the joint rate W, with w = w_F + W a, and the part across the axis acts on the carrier. For
/// an axisymmetric propeller this is -w_F x (I_P w_F + (Izz - Ixx) W a). The hinge rows give the
/// remaining Ixx W (w_F x a), because the relative velocity turns with the axis.
///
/// The frame's rate is taken halfway through the step, by the implicit midpoint rule for the free
/// motion of the whole vehicle (Hairer, Lubich, Wanner, "Geometric Numerical Integration", ch.
/// IV.2: it keeps energy and angular momentum, both quadratic). With the rate at the start, fast
/// tumbling would gain energy. The hinges move the rotors' masses, which does not gain energy
/// either, but loses some in proportion to w^4 dt^3.
void add_gyroscopic_from_carrier(GyroscopicVehicle& vehicle, double dt);

}  // namespace quadcore
