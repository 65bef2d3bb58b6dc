#pragma once

#include "quadcore/plugin/model.hpp"

/// \file
/// What every picture of a vehicle draws of it.

namespace quadcore QUADCORE_EXPORT {

/// The homogeneous box that has the mass and the inertia of a body.
struct InertiaBox {
  Vector3d center;          ///< in the link's axes, from its origin [m]
  Quaterniond orientation;  ///< of its edges in the link
  Vector3d edges;           ///< along its own axes [m]
};

/// Edges are sqrt(6 (Iy + Iz - Ix) / m) and so on, along the principal axes; one that no body can
/// have is 0.
InertiaBox inertia_box(const Inertial& inertial);

/// Radius of the rotors' discs, so that none covers another: 0.4 of the way between the nearest two
/// that are not coaxial, all joints at angle zero [m]; 0.1 of a single one.
double drawn_disc_radius(const Model& model);

}  // namespace quadcore
