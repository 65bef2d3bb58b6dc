#pragma once

#include <cstddef>

/// \file
/// A tree of bodies on hinges as plain numbers. Contains neither Eigen nor code, so that files
/// compiled for a specific processor can include it.

namespace quadcore {

/// Rows of a body's state as in ODE: centre of mass, orientation (x, y, z, w), and velocities in W.
/// The states of all bodies are consecutive, the frame first.
struct BodyRow {
  enum : std::size_t { position = 0, orientation = 3, velocity = 7, rate = 10, count = 13 };
};

/// Rows of the constants of a body and of its hinge on the carrier. Vectors are in the axes of the
/// body that they belong to.
struct BodyConstant {
  enum : std::size_t {
    mass = 0,
    weight = 1,             ///< mass on which gravity acts
    inertia = 2,            ///< about the centre of mass: xx, xy, xz, yy, yz, zz
    origin = 8,             ///< origin of the link from the centre of mass, position of the hinge
    anchor_P = 11,          ///< position of the hinge from the carrier's centre of mass
    axis_C = 14,            ///< axis of the hinge, unit
    axis_P = 17,            ///< axis of the hinge in the carrier
    damping = 20,           ///< damping of the joint as a torque [N m s/rad]
    implicit_damping = 21,  ///< damping of the joint as a row of the solver
    across_C = 22,          ///< two unit vectors perpendicular to the axis and each other
    q_PC_at_zero = 28,      ///< orientation in the carrier at angle zero: x, y, z, w
    count = 32
  };
};

/// Common data of all vehicles of a batch.
struct HingedTree {
  std::size_t bodies;
  const std::size_t* carriers;  ///< carrier of each body except the frame; it precedes the body
  const char* carries;          ///< whether a body carries a hinge
  const char* brakes;           ///< whether a body's hinge has implicit damping
  const char* locks;            ///< whether a body's hinge is locked
  double gravity_W[3];
  double erp, cfm;
  double max_correction;  ///< maximum correction of a hinge that Gazebo does not limit [m/s, rad/s]
};

}  // namespace quadcore
