#pragma once

#include <ode/ode.h>

namespace quadcore {

/// Return whether both geoms are cylinders.
bool are_cylinders(dGeomID one, dGeomID other);

/// Find the contact of two cylinders, and return its number, 0 or 1.
///
/// Minkowski portal refinement of libccd, as in Gazebo 11: G. Snethen, "XenoCollide: Complex
/// Collision Made Simple", Game Programming Gems 7, 2008. ODE 0.16 itself has another formula for
/// axes that are parallel within 4.5 mrad. The position is in the world frame, in m. The normal
/// points from the other cylinder into the first.
int collide_cylinders(dGeomID one, dGeomID other, dContactGeom& point);

}  // namespace quadcore
