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
/// A rotor that has lost a share of what it exerts pushes as far as one that is slower, which is
/// all that changes. Then roll and pitch come first whatever yaw they cost.
///
/// What rotors can exert is a zonotope (Bolender, Doman, JGCD 27(5), 2004): each of its facets,
/// which any three rotors span, bounds the demands that are met.
class Allocation {
 public:
  /// Throws InputError if the rotors do not span thrust and torques.
  explicit Allocation(const Belief& belief);

  /// How many rotors are driven.
  std::size_t rotors() const { return static_cast<std::size_t>(inverse_.rows()); }
  /// Finds the squared speeds that exert a demand.
  /// \param squares  (rotors(),) [rad^2/s^2]
  /// \param lost     (rotors(),) of each rotor the share that is lost of what it exerts; null: none
  /// Returns whether the demand is met; where something is lost, whether it is but for yaw.
  bool allocate(const Demand& demand, double* squares, const double* lost = nullptr) const;
  /// What squared speeds exert.
  Demand exerted(const double* squares, const double* lost = nullptr) const;
  /// Whether rotors that lift so much [N] can turn the vehicle about z either way.
  bool keeps_yaw(double thrust, const double* lost) const;

 private:
  /// Parallel facets: least <= normal . (thrust, torque) <= most, each a sum over the rotors.
  struct Facets {
    Eigen::Vector4d normal;
    VectorXd least, most;
  };
  struct Interval {
    double least, most;
  };
  struct Share {
    double roll_pitch;  ///< of the wanted torques, 0 to 1
    double thrust;      ///< N
    double yaw;         ///< N m
  };
  void find_facets();
  void add_facets(std::vector<Facets>& facets, Eigen::Vector4d scaled_normal) const;
  bool is_within(const Eigen::Vector4d& demand, const double* lost) const;
  Share fit(const Demand& demand, const double* lost, bool at_any_yaw) const;
  /// Torques about z that are left beside others.
  Interval yaw_beside(double thrust, double roll, double pitch, const double* lost) const;
  void redistribute(const Eigen::Vector4d& demand, double* squares, const double* lost) const;

  Eigen::Matrix<double, 4, Eigen::Dynamic> effect_;
  Eigen::Matrix<double, Eigen::Dynamic, 4> inverse_;
  VectorXd least_, most_;       ///< squares
  VectorXd nothing_;            ///< lost
  Eigen::Vector4d size_;        ///< of thrust and torques, so that they can be compared
  Eigen::Matrix4Xd scaled_;     ///< effect_ in these units
  std::vector<Facets> facets_;  ///< in any direction
  std::vector<Facets> level_;   ///< of what is exerted at some yaw: any two rotors span them
};

}  // namespace control
}  // namespace quadcore
