#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/rotor_rows.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Motion of one rotor (the child link of a continuous joint), expressed in the frame's axes.
struct RotorKinematics {
  Vector3d axis_F;    ///< joint axis, unit
  Vector3d normal_F;  ///< z axis of the rotor's link, unit
  Vector3d p_FRcm_F;  ///< centre of mass from F's origin [m]
  Vector3d v_WR_F;    ///< velocity of the link's origin [m/s]
  Vector3d v_WRcm_F;  ///< velocity of the centre of mass [m/s]
  double rate = 0;    ///< joint rate [rad/s]
};

/// Motion of all rotors. Force laws for several rotors at once read the rows; others read one
/// rotor: `motions[i].axis_F` reads three numbers.
class RotorMotions : public RotorRows<MotionRow::count> {
 public:
  /// Create the motion of so many rotors with zeros in all rows.
  explicit RotorMotions(std::size_t rotors) : RotorRows(rotors) {}
  std::size_t size() const { return rotors(); }  ///< number of rotors
  /// Return a copy. It is const so that no one writes to it by mistake.
  const RotorKinematics operator[](std::size_t i) const {
    using Row = MotionRow;
    return {vector(Row::axis, i), vector(Row::normal, i), vector(Row::p_FRcm, i),
            vector(Row::v_WR, i), vector(Row::v_WRcm, i), number(Row::rate, i)};
  }
  /// Return whether every rotor turns slower than this [rad/s]; false for NaN.
  bool slower_than(double rate) const {
    bool all = true;
    for (std::size_t i = 0; i < size(); i += widest_lanes) {
      const double* rates =
          data() + rotor_offset(MotionRow::count, i) + MotionRow::rate * widest_lanes;
      const std::size_t lanes = std::min(size() - i, widest_lanes);
      for (std::size_t j = 0; j < lanes; ++j) all &= std::abs(rates[j]) < rate;
    }
    return all;
  }
  /// Write the rows of RotorKinematics; angle and rotations remain unchanged.
  void set(std::size_t i, const RotorKinematics& rotor) {
    using Row = MotionRow;
    set_vector(Row::axis, i, rotor.axis_F);
    set_vector(Row::normal, i, rotor.normal_F);
    set_vector(Row::p_FRcm, i, rotor.p_FRcm_F);
    set_vector(Row::v_WR, i, rotor.v_WR_F);
    set_vector(Row::v_WRcm, i, rotor.v_WRcm_F);
    number(Row::rate, i) = rotor.rate;
  }
};

/// Motion of the frame at one instant.
struct FrameMotion {
  Vector3d p_WF = Vector3d::Zero();  ///< position of the frame's origin [m]
  double time = 0;                   ///< time of the instant, or of a stage within a step [s]
  Quaterniond q_WF = Quaterniond::Identity();  ///< orientation of the frame, unit
  Matrix3d R_WF = Matrix3d::Identity();        ///< orientation as a matrix
  Vector3d v_WF_F = Vector3d::Zero();          ///< velocity of the frame's origin [m/s]
  Vector3d w_WF_F = Vector3d::Zero();          ///< angular velocity of the frame [rad/s]
  Vector3d p_FCcm_F = Vector3d::Zero();        ///< centre of mass of the vehicle [m]
  Vector3d v_WCcm_F = Vector3d::Zero();        ///< velocity of the centre of mass [m/s]
  Vector3d v_WA_F = Vector3d::Zero();          ///< velocity of the air (wind) [m/s]

  /// Return all numbers in the layout of FrameNumber.
  double* numbers() { return p_WF.data(); }
  /// Return all numbers for reading.
  const double* numbers() const { return p_WF.data(); }
};
static_assert(offsetof(FrameMotion, time) == FrameNumber::time * sizeof(double));
static_assert(offsetof(FrameMotion, q_WF) == FrameNumber::q_WF * sizeof(double));
static_assert(offsetof(FrameMotion, R_WF) == FrameNumber::R_WF * sizeof(double));
static_assert(offsetof(FrameMotion, v_WF_F) == FrameNumber::v_WF_F * sizeof(double));
static_assert(offsetof(FrameMotion, w_WF_F) == FrameNumber::w_WF_F * sizeof(double));
static_assert(offsetof(FrameMotion, p_FCcm_F) == FrameNumber::p_FCcm_F * sizeof(double));
static_assert(offsetof(FrameMotion, v_WCcm_F) == FrameNumber::v_WCcm_F * sizeof(double));
static_assert(offsetof(FrameMotion, v_WA_F) == FrameNumber::v_WA_F * sizeof(double));

/// Motion of the whole vehicle at one instant, the input of all force laws. An engine owns one and
/// refills it for each evaluation.
class Kinematics : public FrameMotion {
 public:
  RotorMotions rotors;  ///< motion of the rotors, in the order of the model's joints

  /// \param has_rotations  whether the engine fills the rows of R_FR instead of the angles
  explicit Kinematics(std::size_t rotor_count, bool has_rotations = true)
      : rotors(rotor_count), has_rotations_(has_rotations) {}

  /// Return whether the engine fills the rows of R_FR instead of the angles.
  bool has_rotations() const { return has_rotations_; }
  /// Return the velocity in world axes of the frame's point S, located at p_FS_F from F's origin
  /// [m/s].
  Vector3d v_WS_W(const Vector3d& p_FS_F) const { return R_WF * (v_WF_F + w_WF_F.cross(p_FS_F)); }

  /// Return the orientation of rotor i's spinning link in the frame.
  Matrix3d R_FR(std::size_t i) const;
  /// Return the angle of joint i in (-pi, pi] [rad].
  double angle(std::size_t i) const;

 private:
  bool has_rotations_;
};

}  // namespace quadcore
