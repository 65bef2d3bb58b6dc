#pragma once

#include "quadcore/control/actuation.hpp"
#include "quadcore/control/attitude_loop.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// \name What a law asks for that ends above the rotors
/// @{

/// An attitude, and a thrust.
struct AttitudeThrust {
  Quaterniond orientation;  ///< of the frame in the world, unit
  double thrust;            ///< along z of F [N]
};
/// Angular velocities, and a thrust.
struct RatesThrust {
  Vector3d w_WF_F;  ///< angular velocity of the frame, its own axes [rad/s]
  double thrust;    ///< along z of F [N]
};
/// @}

/// Flies an attitude or rates with a thrust: the loop around the attitude that the laws on
/// rotations have, then the allocation. Immutable; its state is numbers of its caller, all zero at
/// the beginning.
class InnerLoop {
 public:
  /// Throws InputError on an unknown parameter, on a vehicle that it cannot fly.
  InnerLoop(const VehicleDescription& vehicle, const Values& values,
            const std::vector<double>& spins = {});

  /// Gains of the attitude, parameters of the motors' lead and of the belief.
  static const std::vector<TagSpec>& table();
  /// Numbers of state for so many rotors.
  static std::size_t state_size(std::size_t rotors) { return Actuation::state_size(rotors); }

  /// How many rotors are driven.
  std::size_t rotors() const { return loop_.belief().rotors.size(); }
  /// Speeds to command until the next call.
  /// \param period  since the last call and until the next [s]
  /// \param now     with the velocity in W
  /// \param speeds  (rotors(),) signed [rad/s]
  void command(double period, const Odometry& now, const AttitudeThrust& wanted, double* state,
               double* speeds) const;
  /// The same for angular velocities instead of an attitude.
  void command(double period, const Odometry& now, const RatesThrust& wanted, double* state,
               double* speeds) const;

 private:
  InnerLoop(const Belief& belief, const Values& values);
  void command(double period, const Odometry& now, double thrust, const Vector3d& dw_WF_F,
               double* state, double* speeds) const;

  AttitudeLoop loop_;
  Actuation actuation_;
};

}  // namespace control
}  // namespace quadcore
