#include "lanes/runge_kutta.hpp"
#include "laws/ahead.hpp"
#include "laws/airframe.hpp"
#include "laws/gyrostat.hpp"
#include "laws/motor_torque.hpp"
#include "masks.hpp"

namespace quadcore::batch {
namespace {

/// Offsets of a pack of vehicles.
struct Places {
  const double *constants, *motors;
  double *state, *stage, *sum, *turns;
};

template <Stage stage, class T>
QUADCORE_LAW void share_out(const Places& at, const Share& share, std::size_t row, T k) {
  const StageNumbers numbers{at.state, at.stage, at.sum, at.stage};
  share_out<stage>(numbers, share, row * widest_lanes, k);
}

template <Stage stage, class T>
QUADCORE_LAW void share_out(const Places& at, const Share& share, std::size_t row,
                            const Vec3<T>& k) {
  share_out<stage>(at, share, row, k.x);
  share_out<stage>(at, share, row + 1, k.y);
  share_out<stage>(at, share, row + 2, k.z);
}

template <class T>
QUADCORE_LAW void turn(const Block& block, const Places& at, const double* state) {
  for (std::size_t i = 0; i < block.rotors; ++i) {
    auto turn =
        laws::sine_and_cosine(Table<T>{state}.number(StateRow::joint(StateRow::joint_angle, i)));
    double* rows = at.turns + 2 * i * widest_lanes;
    laws::store(rows, turn.sin);
    laws::store(rows + widest_lanes, turn.cos);
  }
}

/// Compute the rate of a state with the rotations in the table.
template <class T, Stage stage, bool upright>
QUADCORE_LAW void differentiate(const Block& block, const Places& at, const double* from,
                                const Share& share) {
  const Table<T> constants{at.constants}, state{from}, motors{at.motors};
  const Frames<T> frames(state);

  Vec3<T> f_F{T{}, T{}, T{}};
  if (block.laws.drag) {
    const Vec3<T>& v_F = frames.v_WCcm_F;
    f_F = laws::parasitic_drag(v_F, laws::square_root(laws::dot(v_F, v_F)),
                               constants.number(ConstantRow::frame_drag));
  }
  Vec3<T> tau_F =
      -1.0 * laws::cross(frames.w_WF_F, constants.matrix(ConstantRow::I_C_F) * frames.w_WF_F);
  if (block.laws.airframe) {
    const auto k = coefficients_of_airframe(constants);
    f_F = f_F + laws::airframe_force(k, frames.v_WCcm_F);
    tau_F = tau_F + laws::airframe_torque(k, frames.v_WCcm_F, frames.w_WF_F);
  }
  // Once for all rotors.
  Vec3<T> v_WF_W{T{}, T{}, T{}};
  if (block.laws.acting & laws::in_link_axes) v_WF_W = frames.v_WF_W(constants);
  T joint_torques[most_rotors];
  for (std::size_t i = 0; i < block.rotors; ++i) {
    const Rotors<T, upright> rotors{block, frames, v_WF_W, constants, state, at.turns, i};
    laws::RotorLoads<T> loads{{T{}, T{}, T{}}, {T{}, T{}, T{}}, T{}};
    laws::add_rotor_forces(laws_of_rotors(block.laws, constants, i), rotors, loads);
    loads.joint_torque =
        loads.joint_torque +
        laws::motor_torque<T>(motors.number(i * MotorRow::count + MotorRow::active),
                              constants.number(ConstantRow::kp),
                              motors.number(i * MotorRow::count + MotorRow::target), T{},
                              rotors.rate());
    loads.joint_torque = loads.joint_torque - rotors.constant(ConstantRow::damping) * rotors.rate();
    joint_torques[i] = loads.joint_torque;
    f_F = f_F + loads.f_F;
    tau_F = tau_F + laws::rotor_torque(frames.w_WF_F, rotors.axis_F(),
                                       rotors.vector(ConstantRow::p_CRcm_F),
                                       rotors.constant(ConstantRow::moment), rotors.rate(),
                                       loads.f_F, loads.reaction_F, loads.joint_torque);
  }
  const Vec3<T> angular = constants.matrix(ConstantRow::inverse_reduced_I_F) * tau_F;
  for (std::size_t i = 0; i < block.rotors; ++i) {
    const Rotors<T, upright> rotors{block, frames, v_WF_W, constants, state, at.turns, i};
    share_out<stage>(at, share, StateRow::joint(StateRow::joint_angle, i), rotors.rate());
    share_out<stage>(at, share, StateRow::joint(StateRow::joint_rate, i),
                     joint_torques[i] * rotors.constant(ConstantRow::inverse_moment) -
                         laws::dot(rotors.axis_F(), angular));
  }
  share_out<stage>(at, share, StateRow::position, frames.v_WCcm_W);
  const Quaternion<T> q = quaternion_rate(frames.q_WF, frames.w_WF_F);
  share_out<stage>(at, share, StateRow::orientation, Vec3<T>{q.x, q.y, q.z});
  share_out<stage>(at, share, StateRow::orientation + 3, q.w);
  share_out<stage>(at, share, StateRow::velocity,
                   constants.number(ConstantRow::inverse_mass) * (frames.R_WF * f_F) +
                       laws::broadcast<T>(block.gravity_W));
  share_out<stage>(at, share, StateRow::rate, angular);
  if (stage != Stage::last && block.laws.turn()) turn<T>(block, at, at.stage);
}

template <class T>
QUADCORE_LAW void normalise(const Block& block, double* state) {
  double* const q = state + StateRow::orientation * widest_lanes;
  const T x = laws::load<T>(q), y = laws::load<T>(q + widest_lanes),
          z = laws::load<T>(q + 2 * widest_lanes), w = laws::load<T>(q + 3 * widest_lanes);
  const T square = (x * x + y * y) + (z * z + w * w);
  T by = 1.5 - 0.5 * square;  // equals 1/sqrt(s) within rounding near 1, where s stays in steps
  const auto far = laws::absolute(square - 1) >= 1e-8;
  const auto put = [&](std::size_t i, T component)
                       QUADCORE_INLINED { laws::store(q + i * widest_lanes, component); };
  if (__builtin_expect(laws::any(far), 0)) {
    const T root = laws::square_root(square);
    const auto normal = [&](T a)
                            QUADCORE_INLINED { return laws::chosen_by(far, a / root, a * by); };
    put(0, normal(x)), put(1, normal(y)), put(2, normal(z)), put(3, normal(w));
  } else {
    put(0, x * by), put(1, y * by), put(2, z * by), put(3, w * by);
  }
  for (std::size_t i = 0; i < block.rotors; ++i) {
    double* angle = state + StateRow::joint(StateRow::joint_angle, i) * widest_lanes;
    laws::store(angle, laws::within_half_turn(laws::load<T>(angle)));
  }
}

/// Return the vehicles for which no plugin needs to check the state at the start of a step.
template <class T>
QUADCORE_LAW Mask<T> is_quiet(const Block& block, const Table<T>& constants, const Table<T>& state,
                              std::size_t first, double dt) {
  Mask<T> good = ~Mask<T>{};
  const Mask<T> spins = laws::load_bits<T>(block.may_spin + first);
  for (std::size_t i = 0; i < block.rotors; ++i) {
    const T rate = state.number(StateRow::joint(StateRow::joint_rate, i));
    good &= mask<T>(laws::absolute(rate) < block.bounds.fastest) | spins;
  }
  if (block.bounds.has_ground) {
    const T z = state.number(StateRow::position + 2), v_z = state.number(StateRow::velocity + 2);
    good &= mask<T>(z >= block.bounds.reach + laws::ahead(laws::absolute(v_z), dt));
  }
  if (!block.bounds.no_tilt) return good;
  const Frames<T> frames(state);
  const Vec3<T> up_F{frames.R_WF.zx, frames.R_WF.zy, frames.R_WF.zz};
  for (std::size_t i = 0; i < block.rotors; ++i) {
    const Vec3<T> normal_F = constants.vector(ConstantRow::rotor(ConstantRow::R_FR_at_zero + 6, i));
    good &= mask<T>(laws::dot(up_F, normal_F) >= 0) | laws::load_bits<T>(block.may_tilt + first);
  }
  return good;
}

template <class T>
QUADCORE_LAW Outcome<T> outcome(const Block& block, const Table<T>& state) {
  const auto square = [&](std::size_t row) QUADCORE_INLINED {
    const Vec3<T> a = state.vector(row);
    return laws::dot(a, a);
  };
  T rates{};
  for (std::size_t i = 0; i < block.rotors; ++i) {
    const T rate = state.number(StateRow::joint(StateRow::joint_rate, i));
    rates = rates + rate * rate;
  }
  return {square(StateRow::position), square(StateRow::velocity), square(StateRow::rate), rates};
}

template <class T, bool upright>
QUADCORE_LAW void fly(const Block& block, std::size_t first, std::int64_t count, double dt) {
  const std::size_t numbers = StateRow::count(block.rotors) * widest_lanes;
  const Places at{block.constants + first,      block.motors + first,
                  block.state + first,          block.work + first,
                  block.work + numbers + first, block.work + 2 * numbers + first};
  const Table<T> constants{at.constants}, state{at.state}, moved{at.stage};
  Mask<T> flies = laws::load_bits<T>(block.flies + first);
  Mask<T> steps = laws::load_bits<T>(block.steps + first);
  for (std::int64_t n = 0; n < count && laws::any(flies); ++n) {
    flies &= is_quiet(block, constants, state, first, dt);
    if (block.clear) {
      const Vec3<T> v_W = state.vector(StateRow::velocity);
      const T ahead = laws::ahead(laws::square_root(laws::dot(v_W, v_W)), dt);
      flies &= stays_clear(block, first, state.vector(StateRow::position), ahead, steps, count);
    }
    if (block.laws.turn()) turn<T>(block, at, at.state);
    differentiate<T, Stage::first, upright>(block, at, at.state, {1, dt / 2});
    differentiate<T, Stage::between, upright>(block, at, at.stage, {2, dt / 2});
    differentiate<T, Stage::between, upright>(block, at, at.stage, {2, dt});
    differentiate<T, Stage::last, upright>(block, at, at.stage, {1, dt / 6});
    normalise<T>(block, at.stage);
    flies &= is_sound(block.bounds, outcome(block, moved));
    steps -= flies;
    copy_flying<T>(at.stage, at.state, numbers, flies);
    add_rates<T>(block, first, flies, [&](std::size_t i) QUADCORE_INLINED {
      return state.number(StateRow::joint(StateRow::joint_rate, i));
    });
  }
  laws::store_bits<T>(block.steps + first, steps);
}

}  // namespace

template <int W>
void step_block(const Block& block, std::int64_t count, double dt) {
  using T = laws::Pack<W>;
  for (std::size_t first = 0; first < widest_lanes; first += W) {
    if (block.laws.upright) {
      fly<T, true>(block, first, count, dt);
    } else {
      fly<T, false>(block, first, count, dt);
    }
  }
}

template <int W>
void show_block(const Block& block, double* shown) {
  using T = laws::Pack<W>;
  for (std::size_t first = 0; first < widest_lanes; first += W) {
    const Table<T> constants{block.constants + first}, state{block.state + first};
    const Frames<T> frames(state);
    const Vec3<T> p_FCcm_F = constants.vector(ConstantRow::p_FCcm_F);
    const auto put = [&](std::size_t row, const Vec3<T>& a)
                         QUADCORE_INLINED { laws::store3(shown + first + row * widest_lanes, a); };
    put(StateRow::position, state.vector(StateRow::position) - frames.R_WF * p_FCcm_F);
    put(StateRow::velocity, frames.v_WF_W(constants));
    put(StateRow::rate, frames.w_WF_F);
    const auto copy = [&](std::size_t begin, std::size_t end) QUADCORE_INLINED {
      for (std::size_t row = begin; row < end; ++row) {
        laws::store(shown + first + row * widest_lanes, state.number(row));
      }
    };
    copy(StateRow::orientation, StateRow::velocity);
    copy(StateRow::joints, StateRow::count(block.rotors));
  }
}

template void show_block<QUADCORE_LANES>(const Block&, double*);
template void step_block<QUADCORE_LANES>(const Block&, std::int64_t, double);

}  // namespace quadcore::batch
