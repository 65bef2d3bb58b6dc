#pragma once

#include "gyrostat_step.hpp"
#include "lanes/four.hpp"
#include "lanes/turn.hpp"
#include "laws/angles.hpp"
#include "laws/rotors.hpp"

namespace quadcore {

using laws::Four;
using laws::Vec3;

/// Return the offset of rotor i's table in a state.
QUADCORE_LAW std::size_t joint(std::size_t row, std::size_t i) {
  return GyrostatState::joints + rotor_offset(GyrostatState::joint_rows, i) + row * widest_lanes;
}

/// The frame's part of a state. A step keeps it in registers, because each stage waits for the one
/// before.
struct FrameState {
  Four p_WC, q_WF, v_WCcm_W, w_WF_F;

  QUADCORE_LAW static FrameState load(const double* state) {
    using At = GyrostatState;
    return {laws::load<Four>(state + At::position), laws::load<Four>(state + At::orientation),
            laws::load<Four>(state + At::velocity), laws::load<Four>(state + At::rate)};
  }
  QUADCORE_LAW void store(double* state) const {
    using At = GyrostatState;
    laws::store(state + At::position, p_WC);
    laws::store(state + At::orientation, q_WF);
    laws::store(state + At::velocity, v_WCcm_W);
    laws::store(state + At::rate, w_WF_F);
  }
};

/// Motion of the frame in a state.
struct FrameOfState : FrameState {
  laws::Rotation R_WF;
  Four v_WCcm_F;

  // Between the stages, the length of the quaternion deviates from 1 by less than the method's
  // error.
  QUADCORE_LAW explicit FrameOfState(const FrameState& state)
      : FrameState(state), R_WF(laws::rotation(q_WF)), v_WCcm_F(R_WF.from * v_WCcm_W) {}

  QUADCORE_LAW Four v_WF_F(const GyrostatStep& g) const {
    return v_WCcm_F - laws::cross(w_WF_F, laws::load<Four>(g.p_FCcm_F));
  }
};

/// Motion of a pack of rotors in a state, starting at rotor i, see laws/rotor_forces.hpp. If the
/// rotors are `upright`, see GyrostatStep, some components are always zero, and the compiler omits
/// their products.
template <class T, bool upright = false>
struct RotorsOfState {
  const GyrostatStep& g;
  const FrameOfState& frame;
  const double* state;
  std::size_t i;

  QUADCORE_LAW T constant(std::size_t row) const { return laws::load<T>(constants(row)); }
  QUADCORE_LAW Vec3<T> vector(std::size_t row) const { return laws::load3<T>(constants(row)); }

  QUADCORE_LAW T rate() const { return laws::load<T>(state + joint(GyrostatState::joint_rate, i)); }
  QUADCORE_LAW T angle() const {
    return laws::load<T>(state + joint(GyrostatState::joint_angle, i));
  }
  QUADCORE_LAW Vec3<T> axis_F() const {
    if constexpr (upright) return {T{}, T{}, constant(RotorConstant::axis_F + 2)};
    return vector(RotorConstant::axis_F);
  }
  QUADCORE_LAW Vec3<T> normal_F() const {
    if constexpr (upright) return {T{}, T{}, number(MotionRow::normal + 2)};
    if (!g.normals_turn) return laws::load3<T>(shown(MotionRow::normal));
    return turned(laws::load3<T>(shown(MotionRow::R_FR_at_zero + 6)));
  }
  QUADCORE_LAW Vec3<T> velocity_F(bool of_origins) const {
    const std::size_t place = of_origins ? RotorConstant::p_CR_F : RotorConstant::p_CRcm_F;
    return laws::broadcast<T>(frame.v_WCcm_F) + laws::cross(w_WF_F(), vector(place));
  }
  QUADCORE_LAW Vec3<T> in_frame(const Vec3<T>& f_R) const {
    if constexpr (upright) {
      const std::size_t xx = MotionRow::R_FR_at_zero, yx = xx + 1, xy = xx + 3, yy = xx + 4,
                        zz = xx + 8;
      return turned(laws::Matrix3<T>{number(xx), number(xy), T{}, number(yx), number(yy), T{}, T{},
                                     T{}, number(zz)} *
                    f_R);
    }
    const Vec3<T> x = laws::load3<T>(shown(MotionRow::R_FR_at_zero)),
                  y = laws::load3<T>(shown(MotionRow::R_FR_at_zero + 3)),
                  z = laws::load3<T>(shown(MotionRow::R_FR_at_zero + 6));
    return turned(laws::Matrix3<T>{x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z} * f_R);
  }
  QUADCORE_LAW bool windy() const { return g.evaluate_rest; }
  QUADCORE_LAW Vec3<T> v_WA_F() const { return laws::broadcast<T>(g.frame + FrameNumber::v_WA_F); }
  QUADCORE_LAW Vec3<T> w_WF_F() const { return laws::broadcast<T>(frame.w_WF_F); }
  QUADCORE_LAW Vec3<T> v_WF_W() const {
    return laws::broadcast<T>(frame.R_WF.to * frame.v_WF_F(g));
  }

 private:
  QUADCORE_LAW Vec3<T> turned(const Vec3<T>& at_zero_F) const {
    const double* rows = g.turns + rotor_offset(TurnRow::count, i);
    return laws::turned(axis_F(),
                        laws::SineCosine<T>{laws::load<T>(rows + TurnRow::sine * widest_lanes),
                                            laws::load<T>(rows + TurnRow::cosine * widest_lanes)},
                        at_zero_F);
  }
  QUADCORE_LAW const double* constants(std::size_t row) const {
    return g.constants + rotor_offset(RotorConstant::count, i) + row * widest_lanes;
  }
  QUADCORE_LAW T number(std::size_t row) const { return laws::load<T>(shown(row)); }
  QUADCORE_LAW const double* shown(std::size_t row) const {
    return g.motion + rotor_offset(MotionRow::count, i) + row * widest_lanes;
  }
};

/// Fill the table of rotations of a state.
template <int W>
QUADCORE_LAW void turn(const GyrostatStep& g, const double* state) {
  using T = laws::Pack<W>;
  laws::for_each_pack<W>(g.rotors, [&](std::size_t i) QUADCORE_INLINED {
    auto turn = laws::sine_and_cosine(laws::load<T>(state + joint(GyrostatState::joint_angle, i)));
    double* rows = g.turns + rotor_offset(TurnRow::count, i);
    laws::store(rows + TurnRow::sine * widest_lanes, turn.sin);
    laws::store(rows + TurnRow::cosine * widest_lanes, turn.cos);
  });
}

/// Write the motion of a state to the tables that plugins read.
template <int W>
QUADCORE_LAW void show(const GyrostatStep& g, const FrameState& of_frame, const double* state) {
  using T = laws::Pack<W>;
  if (g.normals_turn) turn<W>(g, state);
  FrameOfState frame(of_frame);
  laws::store(g.frame + FrameNumber::q_WF, frame.q_WF);
  laws::store_vector(g.frame + FrameNumber::R_WF, frame.R_WF.to.x);
  laws::store_vector(g.frame + FrameNumber::R_WF + 3, frame.R_WF.to.y);
  laws::store_vector(g.frame + FrameNumber::R_WF + 6, frame.R_WF.to.z);
  laws::store_vector(g.frame + FrameNumber::w_WF_F, frame.w_WF_F);
  laws::store_vector(g.frame + FrameNumber::v_WCcm_F, frame.v_WCcm_F);
  laws::store_vector(g.frame + FrameNumber::v_WF_F, frame.v_WF_F(g));
  laws::store_vector(g.frame + FrameNumber::p_WF,
                     frame.p_WC - frame.R_WF.to * laws::load<Four>(g.p_FCcm_F));
  laws::for_each_pack<W>(g.rotors, [&](std::size_t i) QUADCORE_INLINED {
    const RotorsOfState<T> rotors{g, frame, state, i};
    double* motion = g.motion + rotor_offset(MotionRow::count, i);
    laws::store3(motion + MotionRow::v_WR * widest_lanes, rotors.velocity_F(true));
    laws::store3(motion + MotionRow::v_WRcm * widest_lanes, rotors.velocity_F(false));
    laws::store(motion + MotionRow::rate * widest_lanes, rotors.rate());
    laws::store(motion + MotionRow::angle * widest_lanes, rotors.angle());
    if (g.normals_turn) laws::store3(motion + MotionRow::normal * widest_lanes, rotors.normal_F());
  });
}

}  // namespace quadcore
