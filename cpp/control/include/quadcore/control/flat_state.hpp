#pragma once

#include "quadcore/control/modelled_vehicle.hpp"
#include "quadcore/control/reference.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Return the horizontal unit vector perpendicular to the vertical plane of a yaw.
Vector3d across_yaw(double yaw);

/// State of a vehicle that follows a reference exactly.
struct FlatState {
  Matrix3d R_WF;     ///< orientation
  Vector3d w_WF_F;   ///< angular velocity [rad/s]
  Vector3d dw_WF_F;  ///< angular acceleration [rad/s^2]
  double thrust;     ///< thrust of all rotors along z of F [N]
  /// Acceleration of the centre of mass relative to the origin of F, in W [m/s^2].
  Vector3d a_FCcm_W = Vector3d::Zero();
  Vector3d across_W;  ///< across_yaw() of the reference
};

/// Return the flat state for a reference. Position and yaw are a flat output of a quadrotor
/// (Mellinger, Kumar, ICRA 2011, sec. III), also with rotor drag (Faessler, Franchi, Scaramuzza,
/// RA-L 2018, sec. II). Apart from a part along z of F, the rotors must exert m (a - g) + d v + q
/// |v| v in W, where d is the mean drag along x and y of F. This force defines z of F, and x of F
/// lies in the vertical plane of the yaw. The reference refers to the origin of F, Newton's law to
/// the centre of mass, so the motion of the latter is found iteratively. Throws Error if the
/// reference is in free fall or points x of F straight up.
/// \param with_drag  whether to compensate the modelled drag
FlatState flat_state(const Reference& wanted, const ModelledVehicle& model, bool with_drag);

/// Return the torque of the rotors about the centre of mass for the angular acceleration w' =
/// dw_WF_F [N m]: I w' + w x (I w + h) minus the aerodynamic torque.
/// \param h_F  angular momentum of the rotors, relative to the frame [kg m^2/s]
Vector3d torque_for(const ModelledVehicle& model, const Vector3d& dw_WF_F, const Vector3d& w_WF_F,
                    const Vector3d& h_F, const Vector3d& tau_air_F);

}  // namespace control
}  // namespace quadcore
