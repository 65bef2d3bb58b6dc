#pragma once

#include "quadcore/control/actuation.hpp"
#include "quadcore/control/attitude_loop.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// \name Demands of controllers that do not command the rotors
/// @{

/// Attitude and thrust.
struct AttitudeThrust {
  Quaterniond orientation;  ///< orientation of the frame in the world, unit quaternion
  double thrust;            ///< along z of F [N]
};
/// Angular velocity and thrust.
struct RatesThrust {
  Vector3d w_WF_F;  ///< angular velocity of the frame, its own axes [rad/s]
  double thrust;    ///< along z of F [N]
};
/// Torque and thrust of all rotors.
struct WrenchThrust {
  Vector3d torque_F;  ///< about the centre of mass [N m]
  double thrust;      ///< along z of F [N]
};
/// @}

/// Controls attitude or angular velocity with a thrust: the attitude controller of the geometric
/// controllers, then the allocation. Immutable; the caller owns the state, which is all zero at the
/// start.
class InnerLoop {
 public:
  /// Throws InputError for an unknown parameter or an unsuitable vehicle.
  InnerLoop(const VehicleDescription& vehicle, const Values& values,
            const std::vector<double>& spins = {});

  /// Return the attitude gains and the parameters of the lag compensation and of the model errors.
  static const std::vector<TagSpec>& table();
  /// Return the number of state values for so many rotors.
  static std::size_t state_size(std::size_t rotors) { return Actuation::state_size(rotors); }

  /// Return the number of driven rotors.
  std::size_t rotors() const { return loop_.model().rotors.size(); }
  /// Compute the speeds to command until the next call.
  /// \param period  time since the last call and until the next [s]
  /// \param now     odometry with the velocity in W
  /// \param speeds  (rotors(),) signed [rad/s]
  void command(double period, const Odometry& now, const AttitudeThrust& wanted, double* state,
               double* speeds) const;
  /// Compute the speeds for an angular velocity instead of an attitude.
  void command(double period, const Odometry& now, const RatesThrust& wanted, double* state,
               double* speeds) const;
  /// Compute the speeds for a torque; the gains have no effect.
  void command(double period, const Odometry& now, const WrenchThrust& wanted, double* state,
               double* speeds) const;

 private:
  InnerLoop(const ModelledVehicle& model, const Values& values);
  void command(double period, const Odometry& now, double thrust, const Vector3d& dw_WF_F,
               double* state, double* speeds) const;

  AttitudeLoop loop_;
  Actuation actuation_;
};

}  // namespace control
}  // namespace quadcore
