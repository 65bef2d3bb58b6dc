#pragma once

#include <cstddef>

#include "laws/law_views.hpp"
#include "quadcore/plugin/rotor_layout.hpp"

namespace quadcore {

/// Layout of a gyrostat's state or its rate: p_WC, quaternion of F in W (x, y, z, w), v_WC_W and
/// w_WF_F, each in four numbers; then a table of joint rates and angles.
struct GyrostatState {
  enum : std::size_t { position = 0, orientation = 4, velocity = 8, rate = 12, joints = 16 };
  enum : std::size_t { joint_rate, joint_angle, joint_rows };
};

/// Rows of the rotations of the rotors' links from their orientation at joint angle zero.
struct TurnRow {
  enum : std::size_t { sine, cosine, count };
};

/// Rows for rotors with prescribed rates.
struct GivenRateRow {
  enum : std::size_t {
    free,    ///< 1 for a joint driven by torques, else 0
    slope,   ///< derivative of a prescribed rate [rad/s^2]
    torque,  ///< reaction of a prescribed rate on the carrier [N m]
    count
  };
};

/// Rows of each rotor's constants.
struct RotorConstant {
  enum : std::size_t {
    axis_F = 0,
    p_CR_F = 3,    ///< link's origin from the vehicle's centre of mass
    p_CRcm_F = 6,  ///< rotor's centre of mass from the vehicle's centre of mass
    moment = 9,
    inverse_moment = 10,
    damping = 11,
    count = 12
  };
};

/// All data that a step of the gyrostat reads and writes; matrices are stored by columns. The
/// equations are in cpp/physics/laws/gyrostat.hpp.
struct GyrostatStep {
  std::size_t rotors;
  const double* constants;  ///< table of RotorConstant
  bool normals_turn;        ///< whether some rotor link's z is off the joint's axis
  bool upright;             ///< whether each rotor's axis and its link's z are along the frame's z
  double inverse_mass;
  double p_FCcm_F[4], gravity_W[4];               ///< each followed by 0
  double I_C_F[3][4], inverse_reduced_I_F[3][4];  ///< columns, each followed by 0

  double *state, *stage, *sum;
  double* joint_torques;  ///< torque of each joint on its rotor
  double* turns;          ///< table of TurnRow

  double* frame;   ///< motion of the frame in the layout of FrameNumber
  double* motion;  ///< table of MotionRow
  double* loads;   ///< table of LoadRow
  const double *frame_force_F, *frame_torque_F;  ///< wrench about F's origin
  const double* given_rates;  ///< table of GivenRateRow; null while no rate is prescribed

  bool laws_turn;  ///< whether some force law or normal requires the rotations
  LawViews laws;
  /// Evaluates everything except the force laws in the present motion: clears the frame's loads and
  /// adds to them and to the rotors' loads. Null if there is nothing else and no wind.
  void (*evaluate_rest)(void* engine);
  /// Throws because the loads are not finite in the present motion.
  void (*refuse)(void* engine);
  void* engine;
};

/// Write the motion of a state to the tables.
template <int W>
void show_gyrostat(const GyrostatStep& g, const double* state);

/// Take one step of dt from a time [s] by the classical fourth-order Runge-Kutta method, in code
/// for lanes of width W. At the end the tables contain the motion of `state`.
template <int W>
void step_gyrostat(const GyrostatStep& g, double time, double dt);

}  // namespace quadcore
