#pragma once

#include <cstddef>
#include <cstdint>

#include "laws/rotor_forces.hpp"
#include "quadcore/lane_laws.hpp"
#include "quadcore/plugin/rotor_layout.hpp"

/// \file
/// Memory layout of a batch: vehicles are in blocks of widest_lanes, and tables have a column for
/// each vehicle. Contains neither Eigen nor code, so that files compiled for a specific processor
/// can include it.

namespace quadcore {
struct HingedTree;
}

namespace quadcore::batch {

/// Rows of the state of vehicles: p_WC, quaternion of F in W (x, y, z, w), v_WC_W, w_WF_F, then the
/// joint rate and angle of each rotor.
struct StateRow {
  enum : std::size_t { position = 0, orientation = 3, velocity = 7, rate = 10, joints = 13 };
  enum : std::size_t { joint_rate, joint_angle, joint_rows };

  static constexpr std::size_t joint(std::size_t row, std::size_t rotor) {
    return joints + rotor * joint_rows + row;
  }
  static constexpr std::size_t count(std::size_t rotors) { return joint(0, rotors); }
};

/// Rows of the constants of vehicles, with matrices by columns; then those of each rotor.
struct ConstantRow {
  static constexpr std::size_t number = 1, vector = 3, matrix = 9;
  enum : std::size_t {
    inverse_mass,
    p_FCcm_F = inverse_mass + number,
    I_C_F = p_FCcm_F + vector,
    inverse_reduced_I_F = I_C_F + matrix,
    frame_drag = inverse_reduced_I_F + matrix,
    airframe = frame_drag + number,  ///< AirframeRow
    sim_slow = airframe + AirframeRow::count,
    kp = sim_slow + number,
    fastest = kp + number,               ///< maximum speed of the motors
    motors_sim_slow = fastest + number,  ///< divisor of a commanded speed
    rotors = motors_sim_slow + number
  };
  enum : std::size_t {
    axis_F,
    p_CR_F = axis_F + vector,
    p_CRcm_F = p_CR_F + vector,
    moment = p_CRcm_F + vector,
    inverse_moment = moment + number,
    damping = inverse_moment + number,
    R_FR_at_zero = damping + number,
    coefficients = R_FR_at_zero + matrix,  ///< coefficients of laws::RotorLaws
    rotor_rows = coefficients + laws::RotorLaws::rows
  };

  static constexpr std::size_t rotor(std::size_t row, std::size_t i) {
    return rotors + i * rotor_rows + row;
  }
  static constexpr std::size_t count(std::size_t n) { return rotor(0, n); }
};

/// Maximum number of rotors of a vehicle in the lanes.
constexpr std::size_t most_rotors = 16;

/// Rows of the motors' targets for each rotor.
struct MotorRow {
  enum : std::size_t { active, target, count };
};

/// Rows of a ball without obstacles for each vehicle, within which its centre of mass may move.
struct ClearRow {
  enum : std::size_t { center_W, radius = center_W + 3, count };
};

/// Force laws of the vehicles of a batch.
struct Laws {
  RotorConventions conventions;
  laws::RotorLaws::Places acting;  ///< laws of any vehicle; zero coefficients for the others
  bool drag;                       ///< drag of any frame
  bool airframe;                   ///< other laws of any airframe
  bool upright;                    ///< see GyrostatStep
  bool normals_turn;               ///< see GyrostatStep
  bool aligned;                    ///< whether all links have the axes of the frame at angle zero

  /// Return whether some force law or normal requires the rotations of the rotors.
  bool turn() const { return normals_turn || (acting & laws::in_link_axes); }
};

/// Larger than all bounded numbers, but finite, because compiler options assume finite numbers.
constexpr double unbounded = 1e30;

/// Bounds beyond which a vehicle leaves the steps of its block for its plugins and checks.
struct Bounds {
  double fastest;           ///< joint rate at the start of a step [rad/s]
  bool no_tilt;             ///< whether no rotor's normal may point below the horizon
  bool has_ground;          ///< whether the vehicle must stay above the ground
  double reach;             ///< from the centre of mass; -unbounded if it touches nothing [m]
  double distance_squared;  ///< m^2
  double speed_squared;     ///< m^2/s^2
  double rate_squared;      ///< of the frame, and of all joints in total [rad^2/s^2]
};

/// Data that a step of a block reads and writes.
struct Block {
  std::size_t rotors;
  Laws laws;
  Bounds bounds;
  double gravity_W[3];
  const double* constants;
  double* motors;                ///< table of MotorRow, rotor by rotor
  const std::int64_t* flies;     ///< for each vehicle -1, or 0 if it does not move
  const std::int64_t* may_spin;  ///< -1 for a vehicle without the bound `fastest`
  const std::int64_t* may_tilt;  ///< -1 for a vehicle without the bound no_tilt
  const double* clear;           ///< table of ClearRow; null in a world without obstacles
  double* state;
  double* work;            ///< memory for two states and the sines and cosines of the rotors
  std::int64_t* steps;     ///< number of completed steps of each vehicle, to which steps add theirs
  const HingedTree* tree;  ///< tree of bodies on hinges
  /// Table of laws::VariationRow for the joint rate of each rotor, to which steps add; or null.
  double* variation = nullptr;
};

/// Return the size of a block's work memory.
constexpr std::size_t work_size(std::size_t rotors) {
  return (2 * StateRow::count(rotors) + 2 * rotors) * widest_lanes;
}

/// Advance the vehicles of a block to `count` completed steps of dt [s] of the classical
/// fourth-order Runge-Kutta method, W vehicles at once. A vehicle that reaches a bound stops at the
/// end of the previous step.
template <int W>
void step_block(const Block& block, std::int64_t count, double dt);

/// Write the states of a block like VehicleState: p_WF, the quaternion, v_WF_W, w_WF_F, then rate
/// and angle of each joint, in rows like StateRow.
template <int W>
void show_block(const Block& block, double* shown);

}  // namespace quadcore::batch
