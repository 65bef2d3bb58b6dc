#pragma once

#include <cstddef>

/// \file
/// Bodies on hinges that form a tree, as numbers. Free of Eigen and of code, so that files compiled
/// for one processor may include it.

namespace quadcore {

/// Rows of the state of a body, as ODE has it: its centre of mass, orientation (x, y, z, w),
/// velocities in W. Those of all bodies follow one another, the frame first.
struct BodyRow {
  enum : std::size_t { position = 0, orientation = 3, velocity = 7, rate = 10, count = 13 };
};

/// Rows of what is constant of a body, and of the hinge by which it hangs on its carrier. Vectors
/// are in the axes of the body that they belong to.
struct BodyConstant {
  enum : std::size_t {
    mass = 0,
    weight = 1,             ///< the mass that gravity pulls at
    inertia = 2,            ///< about the centre of mass: xx, xy, xz, yy, yz, zz
    origin = 8,             ///< of the link from the centre of mass; there the hinge is
    anchor_P = 11,          ///< the hinge from the carrier's centre of mass
    axis_C = 14,            ///< of the hinge, unit
    axis_P = 17,            ///< the same in the carrier
    damping = 20,           ///< of the joint, as a torque [N m s/rad]
    implicit_damping = 21,  ///< the same as a row of the solver
    across_C = 22,          ///< two unit vectors across the axis and each other
    q_PC_at_zero = 28,      ///< orientation in the carrier at angle zero: x, y, z, w
    count = 32
  };
};

/// What all vehicles of a batch have in common.
struct HingedTree {
  std::size_t bodies;
  const std::size_t* carriers;  ///< of each body but the frame, which comes before it
  const char* carries;          ///< whether any hinge hangs on a body
  const char* brakes;           ///< whether a body's hinge has implicit damping
  const char* locks;            ///< whether a body's hinge is locked
  double gravity_W[3];
  double erp, cfm;
  double max_correction;  ///< of a hinge that Gazebo does not cap [m/s, rad/s]
};

}  // namespace quadcore
