#pragma once

#include <limits>
#include <string>
#include <vector>

#include "quadcore/plugin/spatial.hpp"

namespace quadcore {

/// A rotor of another vehicle.
struct OtherRotor {
  Vector3d p_WRcm_W = Vector3d::Zero();  ///< position of its centre of mass [m]
  Vector3d f_W = Vector3d::Zero();       ///< sum of all force laws on it: thrust and drag [N]
  /// Radius of its disc [m]; NaN if no plugin of its vehicle sets RotorDescription::radius.
  double radius = std::numeric_limits<double>::quiet_NaN();
};

/// Another vehicle of the same world at the start of a step. All vectors are in world axes.
struct OtherVehicle {
  std::string name;                      ///< name in the fleet
  Vector3d p_WF = Vector3d::Zero();      ///< position of its frame's origin [m]
  Matrix3d R_WF = Matrix3d::Identity();  ///< orientation of its frame
  Vector3d v_WF_W = Vector3d::Zero();    ///< velocity of its frame's origin [m/s]
  Vector3d w_WF_W = Vector3d::Zero();    ///< angular velocity of its frame [rad/s]
  std::vector<OtherRotor> rotors = {};   ///< in the order of its joints
};

/// The other vehicles, in the order of the fleet.
using OtherVehicles = std::vector<const OtherVehicle*>;

}  // namespace quadcore
