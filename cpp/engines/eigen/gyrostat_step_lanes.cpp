#include "gyrostat_motion.hpp"
#include "gyrostat_step.hpp"
#include "lanes/runge_kutta.hpp"
#include "laws/airframe.hpp"
#include "laws/gyrostat.hpp"
#include "laws/motor_torque.hpp"
#include "laws/rotor_forces.hpp"

namespace quadcore {
namespace {

using At = GyrostatState;

template <Stage stage, class T>
QUADCORE_LAW void share_out(const GyrostatStep& g, const Share& share, std::size_t place, T k) {
  share_out<stage>(StageNumbers{g.state, g.stage, g.sum, g.state}, share, place, k);
}

/// Evaluate the loads that are not force laws.
template <int W>
__attribute__((noinline)) void evaluate_rest(const GyrostatStep& g, const double* state) {
  using T = laws::Pack<W>;
  laws::for_each_pack<W>(g.rotors, [&](std::size_t i) QUADCORE_INLINED {
    double* loads = g.loads + rotor_offset(LoadRow::count, i);
    for (std::size_t row = 0; row < LoadRow::count; ++row) {
      laws::store(loads + row * widest_lanes, T{});
    }
  });
  show<W>(g, FrameState::load(state), state);
  g.evaluate_rest(g.engine);
}

template <int W>
[[noreturn]] __attribute__((noinline, cold)) void refuse(const GyrostatStep& g,
                                                         const double* state) {
  show<W>(g, FrameState::load(state), state);
  g.refuse(g.engine);
  __builtin_unreachable();
}

/// Loads of a pack of rotors.
// Not const, here and below: GCC keeps constant aggregates in memory.
template <class T, bool rest, class Rotors>
QUADCORE_LAW laws::RotorLoads<T> loads_of(const GyrostatStep& g, const Rotors& rotors) {
  laws::RotorLoads<T> loads{laws::broadcast<T>(Four{}), laws::broadcast<T>(Four{}), T{}};
  if constexpr (rest) {
    const double* rows = g.loads + rotor_offset(LoadRow::count, rotors.i);
    loads.f_F = laws::load3<T>(rows + LoadRow::force * widest_lanes);
    loads.reaction_F = laws::load3<T>(rows + LoadRow::reaction * widest_lanes);
    loads.joint_torque = laws::load<T>(rows + LoadRow::joint_torque * widest_lanes);
  }
  g.laws.rotor_forces.for_each([&](const RotorForces& law) QUADCORE_INLINED {
    laws::add_rotor_forces(laws::laws_of_rotors<T>(law, rotors.i), rotors, loads);
  });
  g.laws.motor_torques.for_each([&](const MotorTorques& law) QUADCORE_INLINED {
    loads.joint_torque = loads.joint_torque + laws::motor_torque<T>(law, rotors.i, rotors.rate());
  });
  loads.joint_torque = loads.joint_torque - rotors.constant(RotorConstant::damping) * rotors.rate();
  if (rest && g.given_rates) {
    const double* given = g.given_rates + rotor_offset(GivenRateRow::count, rotors.i);
    loads.joint_torque =
        laws::load<T>(given + GivenRateRow::free * widest_lanes) * loads.joint_torque +
        laws::load<T>(given + GivenRateRow::torque * widest_lanes);
  }
  return loads;
}

template <bool rest>
QUADCORE_LAW Four drag_of_frame(const GyrostatStep& g, const FrameOfState& frame) {
  Four sum{};
  if (g.laws.frame_drags.count == 0) return sum;
  Four v_ACcm_F = frame.v_WCcm_F;
  if constexpr (rest) v_ACcm_F = v_ACcm_F - laws::load_vector(g.frame + FrameNumber::v_WA_F);
  const Four squares = v_ACcm_F * v_ACcm_F;
  const double speed = __builtin_sqrt(squares[0] + (squares[1] + squares[2]));
  g.laws.frame_drags.for_each([&](const FrameDrag& law) QUADCORE_INLINED {
    sum = sum + laws::parasitic_drag(v_ACcm_F, speed, law.coefficient);
  });
  return sum;
}

QUADCORE_LAW Four four(const Vec3<double>& a) { return Four{a.x, a.y, a.z, 0}; }

/// Add the loads of the airframe's laws other than parasitic drag.
template <bool rest>
QUADCORE_LAW void add_airframe(const GyrostatStep& g, const FrameOfState& frame, Four& f_F,
                               Four& tau_F) {
  if (g.laws.airframes.count == 0) return;
  Four v_ACcm_F = frame.v_WCcm_F;
  if constexpr (rest) v_ACcm_F = v_ACcm_F - laws::load_vector(g.frame + FrameNumber::v_WA_F);
  const Vec3<double> V_F{v_ACcm_F[0], v_ACcm_F[1], v_ACcm_F[2]};
  const Vec3<double> w_F{frame.w_WF_F[0], frame.w_WF_F[1], frame.w_WF_F[2]};
  g.laws.airframes.for_each([&](const AirframeLaws& law) QUADCORE_INLINED {
    const auto k = [&](std::size_t row) QUADCORE_INLINED { return law.coefficients[row]; };
    f_F = f_F + four(laws::airframe_force(k, V_F));
    tau_F = tau_F + four(laws::airframe_torque(k, V_F, w_F));
  });
}

/// Compute the rate of a state with the rotations in the table, and fill the table for the next
/// stage. `rest` is whether there are loads other than force laws.
/// \param now  the frame's state, then that of the next stage
/// \param sum  sum of its rates
template <int W, Stage stage, bool rest, bool upright>
QUADCORE_LAW void differentiate(const GyrostatStep& g, double* state, FrameState& now,
                                FrameState& sum, const Share& share) {
  using T = laws::Pack<W>;
  using Rotors = RotorsOfState<T, upright>;
  if constexpr (rest) {
    now.store(state);
    evaluate_rest<W>(g, state);
  }
  FrameOfState frame(now);

  Four f_F = drag_of_frame<rest>(g, frame);
  Four tau_F = -laws::cross(frame.w_WF_F, laws::load_columns(g.I_C_F) * frame.w_WF_F);
  add_airframe<rest>(g, frame, f_F, tau_F);
  laws::for_each_pack<W>(g.rotors, [&](std::size_t i) QUADCORE_INLINED {
    const Rotors rotors{g, frame, state, i};
    laws::RotorLoads<T> loads = loads_of<T, rest>(g, rotors);
    laws::store(g.joint_torques + i, loads.joint_torque);
    laws::add_in_order(f_F, loads.f_F);
    laws::add_in_order(
        tau_F,
        laws::rotor_torque(rotors.w_WF_F(), rotors.axis_F(), rotors.vector(RotorConstant::p_CRcm_F),
                           rotors.constant(RotorConstant::moment), rotors.rate(), loads.f_F,
                           loads.reaction_F, loads.joint_torque));
  });
  if constexpr (rest) {
    const Four rest_F = laws::load_vector(g.frame_force_F);
    f_F = f_F + rest_F;
    tau_F = tau_F + (laws::load_vector(g.frame_torque_F) -
                     laws::cross(laws::load<Four>(g.p_FCcm_F), rest_F));
  }
  // Every load is in exactly one of the two sums.
  const Four all = f_F + tau_F;
  if (!laws::is_finite(all[0] + all[1] + all[2])) {
    now.store(state);
    refuse<W>(g, state);
  }

  // The next stage's angles and their sines do not depend on the sums.
  laws::for_each_pack<W>(g.rotors, [&](std::size_t i) QUADCORE_INLINED {
    const Rotors rotors{g, frame, state, i};
    share_out<stage>(g, share, joint(At::joint_angle, i), rotors.rate());
  });
  if (stage != Stage::last && g.laws_turn) turn<W>(g, g.stage);

  const Four angular_F = laws::load_columns(g.inverse_reduced_I_F) * tau_F;
  Vec3<T> angular = laws::broadcast<T>(angular_F);
  laws::for_each_pack<W>(g.rotors, [&](std::size_t i) QUADCORE_INLINED {
    const Rotors rotors{g, frame, state, i};
    T slope = laws::load<T>(g.joint_torques + i) * rotors.constant(RotorConstant::inverse_moment) -
              laws::dot(rotors.axis_F(), angular);
    if (rest && g.given_rates) {
      const double* given = g.given_rates + rotor_offset(GivenRateRow::count, i);
      slope = laws::load<T>(given + GivenRateRow::free * widest_lanes) * slope +
              laws::load<T>(given + GivenRateRow::slope * widest_lanes);
    }
    share_out<stage>(g, share, joint(At::joint_rate, i), slope);
  });
  const FrameState begin = FrameState::load(g.state);
  now.p_WC = share_out<stage>(share, begin.p_WC, sum.p_WC, frame.v_WCcm_W);
  now.q_WF = share_out<stage>(share, begin.q_WF, sum.q_WF,
                              laws::quaternion_rate(frame.q_WF, frame.w_WF_F));
  now.v_WCcm_W =
      share_out<stage>(share, begin.v_WCcm_W, sum.v_WCcm_W,
                       g.inverse_mass * (frame.R_WF.to * f_F) + laws::load<Four>(g.gravity_W));
  now.w_WF_F = share_out<stage>(share, begin.w_WF_F, sum.w_WF_F, angular_F);
}

template <int W>
QUADCORE_LAW void normalise(const GyrostatStep& g, FrameState& now) {
  using T = laws::Pack<W>;
  const Four q = now.q_WF;
  const Four squares = q * q;
  const double square = (squares[0] + squares[1]) + (squares[2] + squares[3]);
  // Near 1, 1/sqrt(s) equals (3 - s)/2 within rounding, and s stays near 1 in steps.
  const bool is_near = laws::absolute(square - 1) < 1e-8;
  now.q_WF = __builtin_expect(is_near, 1) ? q * (1.5 - 0.5 * square) : q / __builtin_sqrt(square);
  laws::for_each_pack<W>(g.rotors, [&](std::size_t i) QUADCORE_INLINED {
    double* angle = g.state + joint(At::joint_angle, i);
    laws::store(angle, laws::within_half_turn(laws::load<T>(angle)));
  });
}

}  // namespace

template <int W>
void show_gyrostat(const GyrostatStep& g, const double* state) {
  show<laws::rotors_in_pack<W>>(g, FrameState::load(state), state);
}

/// Compiled for each case, because features of few vehicles would cost registers for all.
template <int W, bool rest, bool upright>
QUADCORE_LAW void step(const GyrostatStep& g, double time, double dt) {
  double& shown_time = g.frame[FrameNumber::time];
  shown_time = time;
  if (g.laws_turn) turn<W>(g, g.state);
  FrameState frame = FrameState::load(g.state), sum;
  differentiate<W, Stage::first, rest, upright>(g, g.state, frame, sum, {1, dt / 2});
  shown_time = time + dt / 2;
  const double reaches[] = {dt / 2, dt};
  for (const double reach : reaches) {
    differentiate<W, Stage::between, rest, upright>(g, g.stage, frame, sum, {2, reach});
  }
  shown_time = time + dt;
  differentiate<W, Stage::last, rest, upright>(g, g.stage, frame, sum, {1, dt / 6});
  normalise<W>(g, frame);
  frame.store(g.state);
  show<W>(g, frame, g.state);
}

template <int W>
void step_gyrostat(const GyrostatStep& g, double time, double dt) {
  constexpr int pack = laws::rotors_in_pack<W>;
  if (g.evaluate_rest) {
    step<pack, true, false>(g, time, dt);
  } else if (g.upright) {
    step<pack, false, true>(g, time, dt);
  } else {
    step<pack, false, false>(g, time, dt);
  }
}

template void show_gyrostat<QUADCORE_LANES>(const GyrostatStep&, const double*);
template void step_gyrostat<QUADCORE_LANES>(const GyrostatStep&, double, double);

}  // namespace quadcore
