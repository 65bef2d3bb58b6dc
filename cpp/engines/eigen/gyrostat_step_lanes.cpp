#include "gyrostat_step.hpp"
#include "laws/gyrostat.hpp"
#include "laws/rotors.hpp"
#include "laws/turn.hpp"

namespace quadcore {
namespace {

using laws::Columns;
using laws::Four;
using laws::Vec3;
using At = GyrostatState;

/// Where a row of rotor i's table in a state lies.
QUADCORE_LAW std::size_t joint(std::size_t row, std::size_t i) {
  return At::joints + rotor_offset(At::joint_rows, i) + row * widest_lanes;
}

template <int W>
QUADCORE_LAW void show(const GyrostatStep& g, const double* state) {
  using T = laws::Pack<W>;
  // Between the stages the quaternion is off unit length, by less than the method's own error.
  const Four q = laws::load<Four>(state + At::orientation);
  const laws::Rotation R = laws::rotation(q);
  const Four w_WF_F = laws::load<Four>(state + At::rate), p_FCcm_F = laws::load<Four>(g.p_FCcm_F);
  const Four v_WCcm_F = R.from * laws::load<Four>(state + At::velocity);
  const Four v_WF_F = v_WCcm_F - laws::cross(w_WF_F, p_FCcm_F);
  laws::store(g.columns_of_R_WF[0], R.to.x);
  laws::store(g.columns_of_R_WF[1], R.to.y);
  laws::store(g.columns_of_R_WF[2], R.to.z);
  laws::store(g.frame + FrameNumber::q_WF, q);
  laws::store_vector(g.frame + FrameNumber::R_WF, R.to.x);
  laws::store_vector(g.frame + FrameNumber::R_WF + 3, R.to.y);
  laws::store_vector(g.frame + FrameNumber::R_WF + 6, R.to.z);
  laws::store_vector(g.frame + FrameNumber::w_WF_F, w_WF_F);
  laws::store_vector(g.frame + FrameNumber::v_WCcm_F, v_WCcm_F);
  laws::store_vector(g.frame + FrameNumber::v_WF_F, v_WF_F);
  laws::store_vector(g.frame + FrameNumber::p_WF,
                     laws::load<Four>(state + At::position) - R.to * p_FCcm_F);

  const Vec3<T> v = laws::broadcast<T>(g.frame + FrameNumber::v_WF_F),
                w = laws::broadcast<T>(state + At::rate);
  laws::for_each_pack<W>(g.rotors.rotors, [&](std::size_t i) QUADCORE_INLINED {
    const double* constants = g.constants + rotor_offset(RotorConstant::count, i);
    double* motion = g.motion + rotor_offset(MotionRow::count, i);
    const Vec3<T> p_FR_F = laws::load3<T>(constants + RotorConstant::p_FR_F * widest_lanes);
    Vec3<T> velocity_F = v + laws::cross(w, p_FR_F);
    laws::store3(motion + MotionRow::v_WR * widest_lanes, velocity_F);
    if (!g.centered) {
      velocity_F =
          v + laws::cross(w, laws::load3<T>(constants + RotorConstant::p_FRcm_F * widest_lanes));
    }
    laws::store3(motion + MotionRow::v_WRcm * widest_lanes, velocity_F);
    laws::store(motion + MotionRow::rate * widest_lanes,
                laws::load<T>(state + joint(At::joint_rate, i)));
    const T angle = laws::load<T>(state + joint(At::joint_angle, i));
    laws::store(motion + MotionRow::angle * widest_lanes, angle);
    if (g.normals_turn) {
      const Vec3<T> axis_F = laws::load3<T>(constants + RotorConstant::axis_F * widest_lanes);
      const Vec3<T> z_at_zero_F =
          laws::load3<T>(motion + (MotionRow::R_FR_at_zero + 6) * widest_lanes);
      laws::store3(motion + MotionRow::normal * widest_lanes,
                   laws::turned(axis_F, laws::sine_and_cosine(angle), z_at_zero_F));
    }
  });
}

/// What becomes of the rate k of a state: g.sum += weight k, g.stage = g.state + reach k.
struct Share {
  double weight, reach;
};

template <class T>
QUADCORE_LAW void share_out(const GyrostatStep& g, const Share& share, std::size_t at, T k) {
  laws::store(g.sum + at, laws::load<T>(g.sum + at) + share.weight * k);
  laws::store(g.stage + at, laws::load<T>(g.state + at) + share.reach * k);
}

/// work(at, zero) for every pack of a state's numbers; the zero says how wide it is.
template <int W, class Work>
QUADCORE_LAW void for_all(const GyrostatStep& g, const Work& work) {
  for (std::size_t at = 0; at < At::joints; at += laws::lanes_of<Four>) work(at, Four{});
  laws::for_each_pack<W>(g.rotors.rotors, [&](std::size_t i) QUADCORE_INLINED {
    for (std::size_t row = 0; row < At::joint_rows; ++row) work(joint(row, i), laws::Pack<W>{});
  });
}

/// Evaluates the force laws in a state whose motion is shown, and shares out its rate.
template <int W>
QUADCORE_LAW void differentiate(const GyrostatStep& g, const double* state, const Share& share) {
  using T = laws::Pack<W>;
  laws::for_each_pack<W>(g.rotors.rotors, [&](std::size_t i) QUADCORE_INLINED {
    double* loads = g.rotors.loads + rotor_offset(LoadRow::count, i);
    for (std::size_t row = 0; row < LoadRow::count; ++row) {
      laws::store(loads + row * widest_lanes, T{});
    }
  });
  g.evaluate(g.engine);

  const auto joint_torque = [&g](std::size_t i, T rate) {
    const double* constants = g.constants + rotor_offset(RotorConstant::count, i);
    const double* loads = g.rotors.loads + rotor_offset(LoadRow::count, i);
    return laws::load<T>(loads + LoadRow::joint_torque * widest_lanes) -
           laws::load<T>(constants + RotorConstant::damping * widest_lanes) * rate;
  };
  const Four w_WF_F = laws::load<Four>(state + At::rate);
  const Vec3<T> w = laws::broadcast<T>(state + At::rate);
  Four f_F{}, tau_F{};
  laws::for_each_pack<W>(g.rotors.rotors, [&](std::size_t i) QUADCORE_INLINED {
    const double* constants = g.constants + rotor_offset(RotorConstant::count, i);
    const double* loads = g.rotors.loads + rotor_offset(LoadRow::count, i);
    const T rate = laws::load<T>(state + joint(At::joint_rate, i));
    const T q = joint_torque(i, rate);
    const auto rotor =
        laws::rotor_share(w, laws::load3<T>(constants + RotorConstant::axis_F * widest_lanes),
                          laws::load3<T>(constants + RotorConstant::p_FRcm_F * widest_lanes),
                          laws::load<T>(constants + RotorConstant::moment * widest_lanes), rate,
                          laws::load3<T>(loads + LoadRow::force * widest_lanes),
                          laws::load3<T>(loads + LoadRow::reaction * widest_lanes), q);
    laws::add_in_order(f_F, rotor.f_F);
    laws::add_in_order(tau_F, rotor.tau_F);
  });
  f_F = f_F + laws::load_vector(g.frame_force_F);
  tau_F = tau_F + laws::load_vector(g.frame_torque_F) -
          laws::cross(laws::load<Four>(g.p_FCcm_F), f_F);  // now about C
  // Every load is in one of the two sums.
  const Four all = f_F + tau_F;
  if (!(laws::absolute(all[0] + all[1] + all[2]) <= 1.7976931348623157e308)) g.refuse(g.engine);

  const Four angular_F = laws::angular_acceleration(w_WF_F, tau_F, laws::load_columns(g.I_C_F),
                                                    laws::load_columns(g.inverse_reduced_I_F));
  const Vec3<T> angular = laws::broadcast<T>({angular_F[0], angular_F[1], angular_F[2]});
  laws::for_each_pack<W>(g.rotors.rotors, [&](std::size_t i) QUADCORE_INLINED {
    const double* constants = g.constants + rotor_offset(RotorConstant::count, i);
    const Vec3<T> axis_F = laws::load3<T>(constants + RotorConstant::axis_F * widest_lanes);
    const T rate = laws::load<T>(state + joint(At::joint_rate, i));
    share_out(g, share, joint(At::joint_rate, i),
              joint_torque(i, rate) *
                      laws::load<T>(constants + RotorConstant::inverse_moment * widest_lanes) -
                  laws::dot(axis_F, angular));
    share_out(g, share, joint(At::joint_angle, i), rate);
  });
  const Columns R_WF = laws::load_columns(g.columns_of_R_WF);
  const Four orientation = laws::load<Four>(state + At::orientation);
  const Four velocity = laws::load<Four>(state + At::velocity);
  share_out(g, share, At::position, velocity);
  share_out(g, share, At::orientation, laws::quaternion_rate(orientation, w_WF_F));
  share_out(g, share, At::velocity, g.inverse_mass * (R_WF * f_F) + laws::load<Four>(g.gravity_W));
  share_out(g, share, At::rate, angular_F);
}

template <int W>
QUADCORE_LAW void normalise(const GyrostatStep& g) {
  using T = laws::Pack<W>;
  const Four q = laws::load<Four>(g.state + At::orientation);
  const Four squares = q * q;
  const double norm = __builtin_sqrt((squares[0] + squares[1]) + (squares[2] + squares[3]));
  laws::store(g.state + At::orientation, q / norm);
  laws::for_each_pack<W>(g.rotors.rotors, [&](std::size_t i) QUADCORE_INLINED {
    double* angle = g.state + joint(At::joint_angle, i);
    laws::store(angle, laws::within_half_turn(laws::load<T>(angle)));
  });
}

}  // namespace

template <int W>
void show_gyrostat(const GyrostatStep& g, const double* state) {
  show<W>(g, state);
}

template <int W>
void step_gyrostat(const GyrostatStep& g, double time, double dt) {
  static constexpr double weights[] = {1, 2, 2, 1};
  const double reaches[] = {dt / 2, dt / 2, dt, 0};
  for_all<W>(g, [&](std::size_t at, auto zero) QUADCORE_INLINED { laws::store(g.sum + at, zero); });
  const double* state = g.state;
  g.frame[FrameNumber::time] = time;
  for (int stage = 0; stage < 4; ++stage) {
    differentiate<W>(g, state, {weights[stage], reaches[stage]});
    if (stage < 3) {
      g.frame[FrameNumber::time] = time + reaches[stage];
      state = g.stage;
    } else {
      for_all<W>(g, [&](std::size_t at, auto zero) QUADCORE_INLINED {
        using T = decltype(zero);
        laws::store(g.state + at, laws::load<T>(g.state + at) + dt / 6 * laws::load<T>(g.sum + at));
      });
      normalise<W>(g);
      state = g.state;
    }
    show<W>(g, state);
  }
}

template void show_gyrostat<QUADCORE_LANES>(const GyrostatStep&, const double*);
template void step_gyrostat<QUADCORE_LANES>(const GyrostatStep&, double, double);

}  // namespace quadcore
