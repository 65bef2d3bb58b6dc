#pragma once

#include <cstddef>
#include <vector>

#include "quadcore/spatial.hpp"

namespace quadcore {

/// Motion of one rotor (the child link of a continuous joint), expressed in the frame's axes.
struct RotorKinematics {
  Vector3d axis_F;     ///< joint axis, unit
  Vector3d p_FRcm_F;   ///< centre of mass from F's origin [m]
  Vector3d v_WR_F;     ///< velocity of the link's origin [m/s]
  Vector3d v_WRcm_F;   ///< velocity of the centre of mass [m/s]
  double angle = 0;    ///< joint angle in (-pi, pi] [rad]
  double rate = 0;     ///< joint rate [rad/s]
};

/// Motion of the whole vehicle at one instant: all that a force law may read. Engines own one,
/// sized once, and refill it for each evaluation.
class Kinematics {
 public:
  Vector3d p_WF = Vector3d::Zero();       ///< position of the frame's origin [m]
  Quaterniond q_WF = Quaterniond::Identity();  ///< orientation of the frame, unit
  Matrix3d R_WF = Matrix3d::Identity();   ///< the same as a matrix
  Vector3d v_WF_F = Vector3d::Zero();     ///< velocity of the frame's origin [m/s]
  Vector3d w_WF_F = Vector3d::Zero();     ///< angular velocity of the frame [rad/s]
  Vector3d p_FCcm_F = Vector3d::Zero();   ///< centre of mass of the vehicle [m]
  Vector3d v_WCcm_F = Vector3d::Zero();   ///< its velocity [m/s]
  Vector3d v_WA_F = Vector3d::Zero();     ///< velocity of the air (wind) [m/s]
  std::vector<RotorKinematics> rotors;

  explicit Kinematics(std::size_t rotor_count)
      : rotors(rotor_count), R_FR_(rotor_count), R_FR_at_zero_(rotor_count), known_(rotor_count) {}

  /// Orientation of rotor i's spinning link in the frame. Few laws need it and it costs a sine and
  /// a cosine, so engines that do not have it at hand leave it to be computed here when asked for.
  const Matrix3d& R_FR(std::size_t i) const;

  /// For engines: orientation of rotor i at joint angle zero, set once.
  void set_R_FR_at_zero(std::size_t i, const Matrix3d& R) { R_FR_at_zero_[i] = R; }
  /// For engines that know the orientation: sets it.
  void set_R_FR(std::size_t i, const Matrix3d& R) {
    R_FR_[i] = R;
    known_[i] = true;
  }
  /// For engines that do not: marks it to be computed from the angle.
  void forget_R_FR() { known_.assign(known_.size(), 0); }

 private:
  mutable std::vector<Matrix3d> R_FR_;
  std::vector<Matrix3d> R_FR_at_zero_;
  mutable std::vector<char> known_;
};

}  // namespace quadcore
