#pragma once

#include "quadcore/plugin/model.hpp"

/// \file
/// Geometry for drawing a vehicle.

namespace quadcore QUADCORE_EXPORT {

/// Equivalent inertia box: the homogeneous box with the mass and inertia of a body.
struct InertiaBox {
  Vector3d center;          ///< centre in the link's axes, from its origin [m]
  Quaterniond orientation;  ///< orientation of the edges in the link
  Vector3d edges;           ///< lengths of the edges [m]
};

/// Return the equivalent inertia box. Its edges along the principal axes are sqrt(6 (Iy + Iz - Ix)
/// / m) and so on; impossible edges are 0.
InertiaBox inertia_box(const Inertial& inertial);

/// Return a radius for the rotor discs such that none overlaps another [m]: 0.4 times the distance
/// of the nearest two rotors that are not coaxial, with all joints at angle zero; 0.1 for a single
/// rotor.
double drawn_disc_radius(const Model& model);

}  // namespace quadcore
