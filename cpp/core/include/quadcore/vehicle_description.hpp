#pragma once

#include <string>
#include <vector>

#include "quadcore/loads.hpp"
#include "quadcore/model.hpp"

namespace quadcore {

/// A rotor as it stands in the frame, and what the force laws of all plugins make of it.
struct RotorDescription {
  std::string joint;
  Vector3d p_FR_F;    ///< origin of its link [m]
  Vector3d p_FRcm_F;  ///< its centre of mass [m]
  Vector3d axis_F;    ///< unit; a positive rate turns about it by the right-hand rule
  double moment;      ///< moment of inertia about the axis [kg m^2]
  /// Force and torque about the vehicle's centre of mass per squared joint rate, turning with a
  /// positive rate and with a negative one [N s^2/rad^2, N m s^2/rad^2].
  Wrench forward, backward;
};

/// The vehicle as its engine flies it, with what it carries at the start: what a control law would
/// otherwise ask for as tags.
struct VehicleDescription {
  MassProperties body;  ///< of the whole vehicle
  Vector3d gravity_W;   ///< m/s^2
  std::vector<RotorDescription> rotors;
};

}  // namespace quadcore
