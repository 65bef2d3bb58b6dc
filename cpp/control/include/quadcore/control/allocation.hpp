#pragma once

#include <memory>

#include "quadcore/control/modelled_vehicle.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Demand of a control law on the rotors.
struct Demand {
  double thrust = 0;                     ///< along z of F [N]
  Vector3d torque_F = Vector3d::Zero();  ///< about the centre of mass [N m]
};

template <class T>
struct AllocatedRotor;

/// Computes the squared speeds for a demand, thesis eq. (2.51) for any number of rotors: those with
/// the minimum sum of squares within the speed limits. An infeasible demand is met by priority:
/// first as much roll and pitch as possible at any thrust, then the nearest feasible thrust, then
/// as much yaw as remains. A rotor that has lost a fraction of its thrust and torque is limited
/// like a slower rotor. In this case roll and pitch have priority whatever yaw results. The
/// attainable demands form a zonotope (Bolender, Doman, JGCD 27(5), 2004): each of its facets,
/// which any three rotors span, bounds the feasible demands.
class Allocation {
 public:
  /// Throws InputError if the rotors do not span thrust and torques.
  explicit Allocation(const ModelledVehicle& model);

  /// Return the numbers of a rotor.
  const AllocatedRotor<double>& rotor(std::size_t i) const;
  /// Return the number of driven rotors.
  std::size_t rotors() const { return static_cast<std::size_t>(inverse_.rows()); }
  /// Compute the squared speeds for a demand.
  /// \param squares  (rotors(),) [rad^2/s^2]
  /// \param lost     (rotors(),) lost fraction of each rotor's thrust and torque; null: none
  /// Returns whether the demand is met; with a lost fraction, whether it is met apart from yaw.
  bool allocate(const Demand& demand, double* squares, const double* lost = nullptr) const;
  /// Return the thrust and torques of squared speeds.
  Demand exerted(const double* squares, const double* lost = nullptr) const;
  /// Return whether the rotors can yaw the vehicle in both directions at this thrust [N].
  bool can_control_yaw(double thrust, const double* lost) const;

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
    double roll_pitch;  ///< fraction of the wanted torques, 0 to 1
    double thrust;      ///< N
    double yaw;         ///< N m
  };
  bool fits(const double* squares, const double* lost) const;
  void find_facets();
  void add_facets(std::vector<Facets>& facets, Eigen::Vector4d scaled_normal) const;
  bool is_within(const Eigen::Vector4d& demand, const double* lost) const;
  Share fit(const Demand& demand, const double* lost, bool at_any_yaw) const;
  /// Return the range of torques about z that remains next to the others.
  Interval yaw_beside(double thrust, double roll, double pitch, const double* lost) const;
  void redistribute(const Eigen::Vector4d& demand, double* squares, const double* lost) const;

  struct Numbers;
  std::shared_ptr<const Numbers> numbers_;
  Eigen::Matrix<double, Eigen::Dynamic, 4> inverse_;
  VectorXd least_, most_;       ///< squares
  VectorXd nothing_;            ///< lost
  Eigen::Vector4d size_;        ///< scale of thrust and torques for comparison
  Eigen::Matrix4Xd scaled_;     ///< effect_ in units of size_
  std::vector<Facets> facets_;  ///< facets in all directions
  std::vector<Facets> level_;   ///< facets without yaw, spanned by any two rotors
};

}  // namespace control
}  // namespace quadcore
