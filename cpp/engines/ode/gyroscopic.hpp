#pragma once

#include <ode/ode.h>

#include <vector>

#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/spatial.hpp"

/// \file
/// The torque -w x (I w) that makes a tumbling body keep its angular momentum, as the two ODE
/// engines apply it. Upstream ODE's own (implicit) term is off on every body.

namespace quadcore {

/// One body as the gyroscopic laws need it.
struct GyroscopicBody {
  dBodyID body;
  std::size_t parent;  ///< index of the parent body; itself for the frame
  Vector3d axis_B;     ///< joint axis in the body's axes; zero for the frame
  Matrix3d I_Bcm_B;    ///< inertia about the centre of mass in the body's axes [kg m^2]
};

/// A body on a hinge as it is at the start of a step, along the axes of the body that carries it,
/// C.
struct HingedBody {
  Vector3d axis_C;
  Matrix3d I_Bcm_C;
  double rate;  ///< of the joint [rad/s]

  HingedBody(const GyroscopicBody& b, dBodyID carrier);
};

/// A vehicle's bodies in the order of its model's links: the frame, then one for each joint.
struct GyroscopicVehicle {
  std::vector<GyroscopicBody> bodies;
  std::vector<HingedBody> hinged;  ///< all but the frame, filled anew in each step
  /// About the vehicle's centre of mass, of the frame and of the masses of the others [kg m^2].
  Matrix3d I_frame_and_masses_F;
  /// Of what withstands a torque on the frame while the joints are free to turn: the whole
  /// vehicle's inertia less each hinged body's moment about its joint [1/(kg m^2)].
  Matrix3d inverse_reduced_I_F;

  GyroscopicVehicle(const Model& model, const std::vector<dBodyID>& bodies);
};

/// Gazebo 11's: -w x (I w) of each body with its own rate w, explicitly, on that body. On a
/// spinning propeller whose hinge ties it to the frame this acts as a damper on roll and pitch, at
/// a rate of about 4 (Izz - Ixx) W^2 dt / (2 Jx) for four propellers; on a frame that tumbles it
/// makes energy. The published model's faults.
void add_gyroscopic_per_body(GyroscopicVehicle& vehicle, double dt);

/// The right one: the gyroscopic torque of a propeller follows from its carrier's rate w_F and the
/// joint rate W, w = w_F + W a, and what stands across the axis acts on the carrier. For an
/// axisymmetric propeller this is -w_F x (I_P w_F + (Izz - Ixx) W a); the remaining Ixx W (w_F x a)
/// comes out of the hinge rows because the relative velocity turns with the axis.
///
/// The frame's rate is taken halfway through the step, by the implicit midpoint rule for the free
/// motion of the whole vehicle (Hairer, Lubich, Wanner, "Geometric Numerical Integration", ch.
/// IV.2: it keeps energy and angular momentum, both quadratic). With the rate at the start, fast
/// tumbling would gain energy. The rotors' masses are carried round by the hinges, which does not
/// gain energy either, but loses some in proportion to w^4 dt^3.
void add_gyroscopic_from_carrier(GyroscopicVehicle& vehicle, double dt);

}  // namespace quadcore
