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
/// least sum of squares between the slowest and the fastest. What no such speeds exert is met by
/// priority: first as much roll and pitch as any thrust leaves room for, then the thrust that is
/// nearest to the wanted one, then as much yaw as is left.
///
/// What rotors can exert is a zonotope (Bolender, Doman, JGCD 27(5), 2004): each of its facets,
/// which any three rotors span, bounds the demands that are met.
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
  /// Parallel facets: least <= normal . (thrust, torque) <= most.
  struct Facets {
    Eigen::Vector4d normal;
    double least, most;
  };
  struct Share {
    double roll_pitch;  ///< of the wanted torques, 0 to 1
    double thrust;      ///< N
    double yaw;         ///< of the wanted torque, 0 to 1
  };
  void find_facets();
  bool is_within(const Eigen::Vector4d& demand) const;
  Share fit(const Demand& demand) const;
  void redistribute(const Eigen::Vector4d& demand, double* squares) const;

  Eigen::Matrix<double, 4, Eigen::Dynamic> effect_;
  Eigen::Matrix<double, Eigen::Dynamic, 4> inverse_;
  VectorXd least_, most_;    ///< squares
  Eigen::Vector4d size_;     ///< of thrust and torques, so that they can be compared
  Eigen::Matrix4Xd scaled_;  ///< effect_ in these units
  std::vector<Facets> facets_;
};

}  // namespace control
}  // namespace quadcore
