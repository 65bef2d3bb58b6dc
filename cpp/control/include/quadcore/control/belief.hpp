#pragma once

#include <vector>

#include "quadcore/control/settings.hpp"
#include "quadcore/plugin/vehicle_description.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// A rotor as a controller believes it to be. Speeds are those of commands: before any division by
/// sim_slow, positive as `spin` says.
struct BelievedRotor {
  Vector3d axis_F;  ///< unit
  double spin;      ///< sense in which it is commanded to turn about the axis: 1 or -1
  double momentum;  ///< about the axis per unit of speed [kg m^2]
  double lag;       ///< time constant with which it follows a command [s]
  /// Least speed that is commanded [rad/s], 0 or more.
  double slowest, fastest;  ///< greatest speed that is commanded [rad/s], more than that
};

/// What a controller believes of the vehicle it flies.
struct Belief {
  double mass;                        ///< kg
  Vector3d p_FCcm_F;                  ///< centre of mass [m]
  Matrix3d inertia_Ccm_F;             ///< of the whole vehicle [kg m^2]
  double gravity;                     ///< along -z of W [m/s^2]
  AirResistance air;                  ///< what still air does to it
  std::vector<BelievedRotor> rotors;  ///< that are driven, in the order of the command
  /// Force [N] above torque about the centre of mass [N m], in F, per squared speed of each rotor.
  Eigen::Matrix<double, 6, Eigen::Dynamic> effectiveness;

  /// From what is told of the plant, made wrong where values say so.
  /// \param spins  of each rotor; empty: neighbours around the vehicle turn against each other, in
  ///               that of the two ways in which they yaw it more, or else the first positively
  /// Throws InputError where VehicleDescription::driven() does, on a wrong count, on spins other
  /// than 1 and -1, on an odd number of rotors without spins, and if gravity is not along -z.
  static Belief of(const VehicleDescription& vehicle, std::vector<double> spins,
                   const Values& values);
  /// The parameters that make it wrong: factors, and what no description can tell.
  static const std::vector<TagSpec>& table();

  /// \name The air on the vehicle, whose origin of F has these velocities
  /// @{

  /// Force, in W [N].
  Vector3d air_force_W(const Matrix3d& R_WF, const Vector3d& v_WF_W, const Vector3d& w_WF_F) const;
  /// Torque about the centre of mass, in F [N m].
  Vector3d air_torque_F(const Vector3d& v_WF_F, const Vector3d& w_WF_F) const;
  /// @}

 private:
  Vector3d v_WCcm_F(const Vector3d& v_WF_F, const Vector3d& w_WF_F) const {
    return v_WF_F + w_WF_F.cross(p_FCcm_F);
  }
};

}  // namespace control
}  // namespace quadcore
