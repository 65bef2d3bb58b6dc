#pragma once

#include <cstddef>

#include "lanes/pack.hpp"
#include "quadcore/lane_laws.hpp"
#include "quadcore/plugin/rotor_layout.hpp"

namespace quadcore {

/// The layout of a gyrostat's state, or of its rate: p_WC, quaternion of F in W (x, y, z, w),
/// v_WC_W, w_WF_F, each in four numbers; then a table of joint rates and angles.
struct GyrostatState {
  enum : std::size_t { position = 0, orientation = 4, velocity = 8, rate = 12, joints = 16 };
  enum : std::size_t { joint_rate, joint_angle, joint_rows };
};

/// Rows of the turns of the rotors' links from where they are at joint angle zero.
struct TurnRow {
  enum : std::size_t { sine, cosine, count };
};

/// Rows of rotors some of whose joints' rates are given.
struct GivenRateRow {
  enum : std::size_t {
    free,    ///< 1 for a joint that turns as torques make it, else 0
    slope,   ///< derivative of a given rate [rad/s^2]
    torque,  ///< of a given rate's joint: what its carrier bears [N m]
    count
  };
};

/// Rows of what is constant of each rotor.
struct RotorConstant {
  enum : std::size_t {
    axis_F = 0,
    p_CR_F = 3,    ///< the link's origin from the vehicle's centre of mass
    p_CRcm_F = 6,  ///< the rotor's centre of mass from there
    moment = 9,
    inverse_moment = 10,
    damping = 11,
    count = 12
  };
};

/// Some laws of one kind.
template <class Law>
struct Laws {
  const Law* first;
  std::size_t count;

  /// Does work with each. One is what most vehicles have, and no loop lets it stay in registers.
  template <class Work>
  QUADCORE_LAW void for_each(const Work& work) const {
    if (__builtin_expect(count == 1, 1)) {
      work(*first);
    } else {
      for (std::size_t i = 0; i < count; ++i) work(first[i]);
    }
  }
};

/// All that a step of the gyrostat reads and writes; matrices by columns. The equations stand in
/// cpp/physics/laws/gyrostat.hpp.
struct GyrostatStep {
  std::size_t rotors;
  const double* constants;  ///< table of RotorConstant
  bool normals_turn;        ///< some rotor's link has its z off the joint's axis
  bool upright;             ///< each rotor's axis and its link's z lie along the frame's z
  double inverse_mass;
  double p_FCcm_F[4], gravity_W[4];               ///< a 0 behind each
  double I_C_F[3][4], inverse_reduced_I_F[3][4];  ///< columns, a 0 behind each

  double *state, *stage, *sum;
  double* joint_torques;  ///< of each rotor, on it
  double* turns;          ///< table of TurnRow

  double* frame;                                 ///< the motion of the frame, as FrameNumber says
  double* motion;                                ///< table of MotionRow
  double* loads;                                 ///< table of LoadRow
  const double *frame_force_F, *frame_torque_F;  ///< about F's origin
  const double* given_rates;  ///< table of GivenRateRow; null while no joint's rate is given

  bool laws_turn;  ///< some law or normal needs the turns
  Laws<RotorForces> rotor_forces;
  Laws<FrameDrag> frame_drags;
  Laws<MotorTorques> motor_torques;
  /// Evaluates all else in the motion that is shown: clears the frame's loads and adds to them and
  /// to the rotors'. Null if there is nothing else, and the air stands still.
  void (*evaluate_rest)(void* engine);
  /// Throws, because the loads are not finite in the motion that is shown.
  void (*refuse)(void* engine);
  void* engine;
};

/// Shows the motion of a state.
template <int W>
void show_gyrostat(const GyrostatStep& g, const double* state);

/// One step of dt from a time on [s] of the classical fourth-order Runge-Kutta method, W rotors at
/// once. Ends with the motion of `state` shown.
template <int W>
void step_gyrostat(const GyrostatStep& g, double time, double dt);

}  // namespace quadcore
