#pragma once

#include <cstddef>
#include <vector>

#include "quadcore/spatial.hpp"

namespace quadcore {

/// Motion of one rotor (the child link of a continuous joint), expressed in the frame's axes.
struct RotorKinematics {
  Vector3d axis_F;    ///< joint axis, unit
  Vector3d p_FRcm_F;  ///< centre of mass from F's origin [m]
  Vector3d v_WR_F;    ///< velocity of the link's origin [m/s]
  Vector3d v_WRcm_F;  ///< velocity of the centre of mass [m/s]
  double rate = 0;    ///< joint rate [rad/s]
};

/// Motion of the whole vehicle at one instant: all that a force law may read. Engines own one,
/// sized once, and refill it for each evaluation.
class Kinematics {
 public:
  Vector3d p_WF = Vector3d::Zero();            ///< position of the frame's origin [m]
  Quaterniond q_WF = Quaterniond::Identity();  ///< orientation of the frame, unit
  Matrix3d R_WF = Matrix3d::Identity();        ///< the same as a matrix
  Vector3d v_WF_F = Vector3d::Zero();          ///< velocity of the frame's origin [m/s]
  Vector3d w_WF_F = Vector3d::Zero();          ///< angular velocity of the frame [rad/s]
  Vector3d p_FCcm_F = Vector3d::Zero();        ///< centre of mass of the vehicle [m]
  Vector3d v_WCcm_F = Vector3d::Zero();        ///< its velocity [m/s]
  Vector3d v_WA_F = Vector3d::Zero();          ///< velocity of the air (wind) [m/s]
  std::vector<RotorKinematics> rotors;

  explicit Kinematics(std::size_t rotor_count) : rotors(rotor_count), turns_(rotor_count) {}

  /// Orientation of rotor i's spinning link in the frame.
  const Matrix3d& R_FR(std::size_t i) const;
  /// Angle of joint i in (-pi, pi] [rad].
  double angle(std::size_t i) const;

  /// \name For engines
  /// An engine gives the orientation at angle zero once, then the orientation or the angle as it
  /// has them. Few laws need either and they cost trigonometry, so the other is derived when asked
  /// for.
  /// @{
  void set_R_FR_at_zero(std::size_t i, const Matrix3d& R) { turns_[i].R_FR_at_zero = R; }
  void set_R_FR(std::size_t i, const Matrix3d& R) {
    turns_[i].R_FR = R;
    turns_[i].knows_R = true;
    turns_[i].knows_angle = false;
  }
  void set_angle(std::size_t i, double angle) {
    turns_[i].angle = angle;
    turns_[i].knows_R = false;
    turns_[i].knows_angle = true;
  }
  /// @}

 private:
  /// How far a rotor has turned about its joint.
  struct Turn {
    Matrix3d R_FR_at_zero, R_FR;
    double angle = 0;
    bool knows_R = false, knows_angle = true;
  };
  mutable std::vector<Turn> turns_;
};

}  // namespace quadcore
