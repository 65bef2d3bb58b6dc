#pragma once

#include <cstddef>
#include <cstdint>

#include "laws/rotor_forces.hpp"
#include "quadcore/lane_laws.hpp"
#include "quadcore/plugin/rotor_layout.hpp"

/// \file
/// Where the numbers of a batch lie: vehicles in blocks of widest_lanes, whose tables have a column
/// for each vehicle. Free of Eigen and of code, so that files compiled for one processor may
/// include it.

namespace quadcore {
struct HingedTree;
}

namespace quadcore::batch {

/// Rows of the state of vehicles: p_WC, quaternion of F in W (x, y, z, w), v_WC_W, w_WF_F, then for
/// each rotor the rate and the angle of its joint.
struct StateRow {
  enum : std::size_t { position = 0, orientation = 3, velocity = 7, rate = 10, joints = 13 };
  enum : std::size_t { joint_rate, joint_angle, joint_rows };

  static constexpr std::size_t joint(std::size_t row, std::size_t rotor) {
    return joints + rotor * joint_rows + row;
  }
  static constexpr std::size_t count(std::size_t rotors) { return joint(0, rotors); }
};

/// Rows of what is constant of vehicles, matrices by columns; then for each rotor its own.
struct ConstantRow {
  static constexpr std::size_t number = 1, vector = 3, matrix = 9;
  enum : std::size_t {
    inverse_mass,
    p_FCcm_F = inverse_mass + number,
    I_C_F = p_FCcm_F + vector,
    inverse_reduced_I_F = I_C_F + matrix,
    frame_drag = inverse_reduced_I_F + matrix,
    sim_slow = frame_drag + number,
    kp = sim_slow + number,
    fastest = kp + number,               ///< speed that the motors follow
    motors_sim_slow = fastest + number,  ///< by which a commanded speed is divided
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
    coefficients = R_FR_at_zero + matrix,  ///< of laws::RotorLaws
    rotor_rows = coefficients + laws::RotorLaws::rows
  };

  static constexpr std::size_t rotor(std::size_t row, std::size_t i) {
    return rotors + i * rotor_rows + row;
  }
  static constexpr std::size_t count(std::size_t n) { return rotor(0, n); }
};

/// Most rotors of a vehicle that flies so.
constexpr std::size_t most_rotors = 16;

/// Rows of what the motors follow, for each rotor.
struct MotorRow {
  enum : std::size_t { active, target, count };
};

/// Which laws the vehicles of a batch have.
struct Laws {
  RotorConventions conventions;
  laws::RotorLaws::Places acting;  ///< on any of the vehicles; on others with coefficients of zero
  bool drag;                       ///< of any frame
  bool upright;                    ///< as GyrostatStep
  bool normals_turn;               ///< as GyrostatStep

  /// Whether some law or normal needs the turns of the rotors.
  bool turn() const { return normals_turn || (acting & laws::in_link_axes); }
};

/// Larger than what is bounded; finite, because the compiler is told that numbers are.
constexpr double unbounded = 1e30;

/// Where a vehicle leaves the steps of its block, because a plugin or a check has to look closer.
struct Bounds {
  double fastest;           ///< rate of a joint as a step begins [rad/s]
  bool no_tilt;             ///< no rotor's normal may point below the horizon then
  double reach;             ///< of the vehicle from its centre of mass, were the ground there [m]
  double distance_squared;  ///< m^2
  double speed_squared;     ///< m^2/s^2
  double rate_squared;      ///< of the frame, and of all joints together [rad^2/s^2]
};

/// What a step of a block reads and writes.
struct Block {
  std::size_t rotors;
  Laws laws;
  Bounds bounds;
  double gravity_W[3];
  const double* constants;
  const double* motors;          ///< table of MotorRow, rotor by rotor
  const std::int64_t* flies;     ///< of each vehicle -1, or 0 for one that stays where it is
  const std::int64_t* may_spin;  ///< -1 for a vehicle that `fastest` does not bind
  const std::int64_t* may_tilt;  ///< -1 for a vehicle that no_tilt does not bind
  double* state;
  double* work;         ///< room for two states and the sines and cosines of the rotors
  std::int64_t* steps;  ///< of each vehicle: how many it has flown of those asked for
  const HingedTree* tree = nullptr;  ///< of bodies on hinges
};

/// Numbers of a block's work.
constexpr std::size_t work_size(std::size_t rotors) {
  return (2 * StateRow::count(rotors) + 2 * rotors) * widest_lanes;
}

/// Flies the vehicles of a block `count` steps of dt [s] of the classical fourth-order Runge-Kutta
/// method, W of them at once. One that meets a bound stays where the step before it ended.
template <int W>
void step_block(const Block& block, std::int64_t count, double dt);

/// Writes the states of a block as VehicleState has them: p_WF, the quaternion, v_WF_W, w_WF_F,
/// then rate and angle of each joint, in rows as StateRow has them.
template <int W>
void show_block(const Block& block, double* shown);

}  // namespace quadcore::batch
