#pragma once

#include <vector>

#include "quadcore/control/settings.hpp"
#include "quadcore/plugin/vehicle_description.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// A rotor in a controller's model. Speeds are commanded speeds: before any division by sim_slow,
/// and positive in the direction of `spin`.
struct ModelledRotor {
  Vector3d axis_F;  ///< unit
  double spin;      ///< direction of rotation about the axis: 1 or -1
  double momentum;  ///< angular momentum about the axis per unit of speed [kg m^2]
  double lag;       ///< time constant of the response to a command [s]
  /// Minimum commanded speed [rad/s], at least 0.
  double slowest, fastest;  ///< maximum commanded speed [rad/s], above the minimum
};

/// A controller's model of the vehicle.
struct ModelledVehicle {
  double mass;                        ///< kg
  Vector3d p_FCcm_F;                  ///< centre of mass [m]
  Matrix3d inertia_Ccm_F;             ///< inertia of the whole vehicle [kg m^2]
  double gravity;                     ///< along -z of W [m/s^2]
  AirResistance air;                  ///< resistance of still air
  std::vector<ModelledRotor> rotors;  ///< driven rotors, in the order of the command
  /// Force [N] stacked on the torque about the centre of mass [N m], in F, per squared speed of
  /// each rotor.
  Eigen::Matrix<double, 6, Eigen::Dynamic> effectiveness;

  /// Create the model from the true vehicle and the model errors in `values`.
  /// \param spins  direction of each rotor; if empty, see find_spins()
  /// Throws InputError like VehicleDescription::driven(), for spins that are not 1 or -1 for each
  /// rotor, for unknown spins, and if gravity is not along -z.
  static ModelledVehicle of(const VehicleDescription& vehicle, std::vector<double> spins,
                            const Values& values);
  /// Return the parameters of the model errors and of speed limits.
  static const std::vector<TagSpec>& table();

  /// \name Aerodynamic load for given velocities of the origin of F
  /// @{

  /// Return the force in W [N].
  Vector3d air_force_W(const Matrix3d& R_WF, const Vector3d& v_WF_W, const Vector3d& w_WF_F) const;
  /// Return the torque about the centre of mass in F [N m].
  Vector3d air_torque_F(const Vector3d& v_WF_F, const Vector3d& w_WF_F) const;
  /// @}
};

}  // namespace control
}  // namespace quadcore
