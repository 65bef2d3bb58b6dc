#pragma once

#include "block.hpp"
#include "lanes/four.hpp"
#include "lanes/table.hpp"
#include "lanes/turn.hpp"
#include "laws/angles.hpp"
#include "laws/rotor_forces.hpp"

namespace quadcore::batch {

using laws::Matrix3;
using laws::Quaternion;
using laws::Vec3;

/// The numbers of some vehicles of a block, starting at one of them.
template <class T>
using Table = laws::Table<T, widest_lanes>;

/// Like laws::quaternion_rate().
template <class T>
QUADCORE_LAW Quaternion<T> quaternion_rate(const Quaternion<T>& q, const Vec3<T>& w_F) {
  const Vec3<T> h = 0.5 * w_F;
  return {q.w * h.x + (q.y * h.z - q.z * h.y), q.z * h.x + (q.w * h.y - q.x * h.z),
          (q.x * h.y + q.w * h.z) - q.y * h.x, -q.x * h.x - (q.y * h.y + q.z * h.z)};
}

/// Motion of the frames of a pack of vehicles.
template <class T>
struct Frames {
  Quaternion<T> q_WF;
  Vec3<T> v_WCcm_W, w_WF_F;
  Matrix3<T> R_WF;
  Vec3<T> v_WCcm_F;

  QUADCORE_LAW explicit Frames(const Table<T>& state)
      : q_WF{state.number(StateRow::orientation), state.number(StateRow::orientation + 1),
             state.number(StateRow::orientation + 2), state.number(StateRow::orientation + 3)},
        v_WCcm_W(state.vector(StateRow::velocity)),
        w_WF_F(state.vector(StateRow::rate)),
        R_WF(rotation(q_WF)),
        v_WCcm_F(inversely(R_WF, v_WCcm_W)) {}

  QUADCORE_LAW Vec3<T> v_WF_W(const Table<T>& constants) const {
    return R_WF * (v_WCcm_F - laws::cross(w_WF_F, constants.vector(ConstantRow::p_FCcm_F)));
  }
};

/// Motion of the i-th rotors of a pack of vehicles, see laws/rotor_forces.hpp. `upright` as in
/// RotorsOfState.
template <class T, bool upright>
struct Rotors {
  const Block& block;
  const Frames<T>& frames;
  const Vec3<T>& of_frames_W;  ///< Frames::v_WF_W(), if some law requires it
  Table<T> constants, state;
  const double* turns;  ///< sine and cosine of rotor 0
  std::size_t i;

  QUADCORE_LAW T constant(std::size_t row) const {
    return constants.number(ConstantRow::rotor(row, i));
  }
  QUADCORE_LAW Vec3<T> vector(std::size_t row) const {
    return constants.vector(ConstantRow::rotor(row, i));
  }
  QUADCORE_LAW T rate() const { return state.number(StateRow::joint(StateRow::joint_rate, i)); }
  QUADCORE_LAW Vec3<T> axis_F() const {
    if constexpr (upright) return {T{}, T{}, constant(ConstantRow::axis_F + 2)};
    return vector(ConstantRow::axis_F);
  }
  QUADCORE_LAW Vec3<T> normal_F() const {
    if constexpr (upright) return {T{}, T{}, constant(ConstantRow::R_FR_at_zero + 8)};
    const Vec3<T> at_zero = vector(ConstantRow::R_FR_at_zero + 6);
    if (!block.laws.normals_turn) return at_zero;
    return turned(at_zero);
  }
  QUADCORE_LAW Vec3<T> velocity_F(bool of_origins) const {
    return frames.v_WCcm_F + laws::cross(frames.w_WF_F, vector(of_origins ? ConstantRow::p_CR_F
                                                                          : ConstantRow::p_CRcm_F));
  }
  QUADCORE_LAW Vec3<T> in_frame(const Vec3<T>& f_R) const {
    if (block.laws.aligned) return turned(f_R);
    Matrix3<T> R_FR_at_zero = constants.matrix(ConstantRow::rotor(ConstantRow::R_FR_at_zero, i));
    if constexpr (upright) {
      R_FR_at_zero.xz = R_FR_at_zero.yz = R_FR_at_zero.zx = R_FR_at_zero.zy = T{};
    }
    return turned(R_FR_at_zero * f_R);
  }
  QUADCORE_LAW bool windy() const { return false; }
  QUADCORE_LAW Vec3<T> v_WA_F() const { return {T{}, T{}, T{}}; }
  QUADCORE_LAW Vec3<T> w_WF_F() const { return frames.w_WF_F; }
  QUADCORE_LAW Vec3<T> v_WF_W() const { return of_frames_W; }

 private:
  QUADCORE_LAW Vec3<T> turned(const Vec3<T>& at_zero_F) const {
    const double* rows = turns + 2 * i * widest_lanes;
    return laws::turned(
        axis_F(), laws::SineCosine<T>{laws::load<T>(rows), laws::load<T>(rows + widest_lanes)},
        at_zero_F);
  }
};

/// Force laws of the i-th rotors of a pack of vehicles, which are all intact.
template <class T>
QUADCORE_LAW laws::LawsOfRotors<T> laws_of_rotors(const Laws& laws, const Table<T>& constants,
                                                  std::size_t i) {
  return {laws.conventions,
          laws.acting,
          {constants.first + ConstantRow::rotor(ConstantRow::coefficients, i) * widest_lanes},
          laws::broadcast<T>(1),
          constants.number(ConstantRow::sim_slow)};
}

/// Return the airframe's coefficients as a function of AirframeRow.
template <class T>
QUADCORE_LAW auto coefficients_of_airframe(const Table<T>& constants) {
  return [&constants](std::size_t row)
             QUADCORE_INLINED { return constants.number(ConstantRow::airframe + row); };
}

}  // namespace quadcore::batch
