#pragma once

#include "laws/drag.hpp"
#include "laws/flapping.hpp"
#include "laws/rotors.hpp"
#include "laws/thrust.hpp"
#include "laws/turn.hpp"

namespace quadcore::aerodynamic {

using laws::RotorDisc;
using laws::Vec3;

/// Rows of the coefficients, a column for each rotor; 0 for rotors that are somebody else's.
struct CoefficientRow {
  enum : std::size_t { k, b, induced, translational, profile, linear, parasitic, count };
};

/// What of the law a vehicle keeps.
struct RotorForces {
  const double* coefficients;
  std::size_t normal_row;    ///< of the discs' normals
  std::size_t velocity_row;  ///< of the discs' velocities
  bool meets_wind;           ///< whether the discs meet the moving air, or air that stands still
  bool about_frame_z;        ///< reaction torques act so, however the rotors stand
  bool on_rotor;             ///< reaction torques act about the joints' axes on the rotors
  bool parasitic;            ///< each rotor takes the appendix' parasitic drag
  bool flaps;                ///< any flapping coefficient is set
  laws::Flapping flapping;
  double sim_slow;
};

/// The law in one motion.
struct RotorForcesNow {
  const RotorForces& law;
  RotorLanes rotors;
  const double* frame;  ///< FrameNumber

  QUADCORE_LAW Vec3<double> vector(std::size_t number) const { return laws::vec(frame + number); }
  /// \name Rows from rotor i on
  /// @{
  template <class T>
  QUADCORE_LAW T number(std::size_t row, std::size_t i) const {
    return laws::load<T>(motion(row, i));
  }
  template <class T>
  QUADCORE_LAW Vec3<T> vector(std::size_t row, std::size_t i) const {
    return laws::load3<T>(motion(row, i));
  }
  template <class T>
  QUADCORE_LAW T coefficient(std::size_t row, std::size_t i) const {
    return laws::load<T>(law.coefficients + rotor_offset(CoefficientRow::count, i) +
                         row * widest_lanes);
  }
  /// @}

  template <class T>
  QUADCORE_LAW RotorDisc<T> disc(std::size_t i) const {
    const Vec3<T> normal_F = vector<T>(law.normal_row, i);
    Vec3<T> v_AR_F = vector<T>(law.velocity_row, i);
    if (law.meets_wind) v_AR_F = v_AR_F - laws::broadcast<T>(vector(FrameNumber::v_WA_F));
    return {normal_F, number<T>(MotionRow::rate, i) * law.sim_slow, laws::across(normal_F, v_AR_F)};
  }

  template <class T>
  QUADCORE_LAW T reaction(const RotorDisc<T>& disc, std::size_t i) const {
    return laws::reaction(disc, coefficient<T>(CoefficientRow::b, i));
  }

  /// Unit, about which the reaction torque acts on the vehicle, unless it acts about the frame's z.
  template <class T>
  QUADCORE_LAW Vec3<T> reaction_axis_F(const RotorDisc<T>& disc, std::size_t i) const {
    return law.on_rotor ? vector<T>(MotionRow::axis, i) : disc.axis_F;
  }

  template <class T>
  QUADCORE_LAW Vec3<T> parasitic_F(std::size_t i) const {
    const Vec3<T> f_R = laws::parasitic_drag_of_appendix(
        laws::broadcast<T>(laws::matrix(frame + FrameNumber::R_WF) * vector(FrameNumber::v_WF_F)),
        coefficient<T>(CoefficientRow::parasitic, i));
    if (rotors.has_rotations) return columns<T>(MotionRow::R_FR, i) * f_R;
    return laws::turned(vector<T>(MotionRow::axis, i),
                        laws::sine_and_cosine(number<T>(MotionRow::angle, i)),
                        columns<T>(MotionRow::R_FR_at_zero, i) * f_R);
  }

  template <class T>
  QUADCORE_LAW Vec3<T> flapping_F(const RotorDisc<T>& disc, std::size_t i) const {
    return laws::flapping(disc, laws::broadcast<T>(vector(FrameNumber::w_WF_F)),
                          coefficient<T>(CoefficientRow::k, i), law.flapping);
  }

 private:
  QUADCORE_LAW const double* motion(std::size_t row, std::size_t i) const {
    return rotors.motion + rotor_offset(MotionRow::count, i) + row * widest_lanes;
  }
  template <class T>
  QUADCORE_LAW laws::Matrix3<T> columns(std::size_t row, std::size_t i) const {
    const Vec3<T> x = vector<T>(row, i), y = vector<T>(row + 3, i), z = vector<T>(row + 6, i);
    return {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z};
  }
};

/// Adds forces and reactions of all rotors to their loads, W rotors at once.
template <int W>
void add_rotor_forces(const RotorForcesNow& now);

}  // namespace quadcore::aerodynamic
