#pragma once

#include "quadcore/control/belief.hpp"
#include "quadcore/control/reference.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// What a vehicle does that follows a reference exactly.
struct FlatState {
  Matrix3d R_WF;     ///< orientation
  Vector3d w_WF_F;   ///< angular velocity [rad/s]
  Vector3d dw_WF_F;  ///< its derivative [rad/s^2]
  double thrust;     ///< of all rotors along z of F [N]
  /// Acceleration of the centre of mass beside that of the origin of F, in W [m/s^2].
  Vector3d a_FCcm_W = Vector3d::Zero();
};

/// The flat output of a quadrotor is its position and yaw (Mellinger, Kumar, ICRA 2011, sec. III);
/// it remains so with rotor drag (Faessler, Franchi, Scaramuzza, RA-L 2018, sec. II): what the
/// rotors must exert is m (a - g) + d v + q |v| v in W but for a part along z of F, d being the
/// mean drag along x and y of F. z of F is its direction, and x of F stands in the vertical plane
/// of the yaw, which makes the yaw that of roll, pitch and yaw. The reference is that of the origin
/// of F, and Newton's law that of the centre of mass, see at_centre_of_mass(). Throws Error where
/// the reference falls so fast that no direction is left, or lays x of F straight up.
/// \param with_drag  whether the believed drag is made up for
FlatState flat_state(const Reference& wanted, const Belief& belief, bool with_drag);

/// Where the centre of mass is to be, of a vehicle whose origin of F follows a reference in such an
/// attitude: r being the way to it, p + r with v + w x r, a + w' x r + w x (w x r) and so on. A
/// reference ends with the snap, which leaves the second and third derivative of w open: in F they
/// are taken for zero, as they are in a steady turn.
Reference at_centre_of_mass(const Reference& wanted, const Belief& belief, const FlatState& flat);

/// Orientation whose z is the given direction, not zero, and whose x stands in the vertical plane
/// of the yaw.
Matrix3d attitude_of(const Vector3d& z_W, double yaw);

/// Torque of the rotors about the centre of mass that turns the vehicle with w' = dw_WF_F [N m]:
/// I w' + w x (I w + h) less that of the air.
/// \param h_F  angular momentum of the rotors, relative to the frame [kg m^2/s]
Vector3d torque_for(const Belief& belief, const Vector3d& dw_WF_F, const Vector3d& w_WF_F,
                    const Vector3d& h_F, const Vector3d& tau_air_F);

}  // namespace control
}  // namespace quadcore
