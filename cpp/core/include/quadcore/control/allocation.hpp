#pragma once

#include "quadcore/control/belief.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// What a law asks of the rotors.
struct Demand {
  double thrust = 0;                     ///< along z of F [N]
  Vector3d torque_F = Vector3d::Zero();  ///< about the centre of mass [N m]
};

/// Squared speeds that exert a demand, thesis eq. (2.51) for any number of rotors: those with the
/// least sum of squares, and where they do not fit between the slowest and the fastest, by
/// priority: first as much roll and pitch as any thrust leaves room for, then the thrust that is
/// nearest to the wanted one, then as much yaw as is left.
class Allocation {
 public:
  /// Throws InputError if the rotors do not span thrust and torques.
  explicit Allocation(const Belief& belief);

  std::size_t rotors() const { return static_cast<std::size_t>(inverse_.rows()); }
  /// \param squares  (rotors(),) [rad^2/s^2]
  /// Returns whether the demand is met.
  bool allocate(const Demand& demand, double* squares) const;
  /// What squared speeds exert.
  Demand exerted(const double* squares) const;

 private:
  struct Share {
    double roll_pitch;  ///< of the wanted torques, 0 to 1
    double thrust;      ///< N
  };
  Share fit(const Eigen::Ref<const VectorXd>& of_torques, double thrust) const;

  Eigen::Matrix<double, 4, Eigen::Dynamic> effect_;
  Eigen::Matrix<double, Eigen::Dynamic, 4> inverse_;
  VectorXd least_, most_;  ///< squares
};

}  // namespace control
}  // namespace quadcore
