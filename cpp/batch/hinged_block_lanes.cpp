#include "hinged_block.hpp"
#include "laws/airframe.hpp"
#include "laws/motor_torque.hpp"
#include "masks.hpp"
#include "ode/beside_contact.hpp"
#include "ode/hinged_motion.hpp"

namespace quadcore::batch {
namespace {

template <class T>
using Bodies = HingedBodies<T, Lanes::vehicles>;

/// Offsets of a pack of vehicles, starting at the first of them.
template <class T>
struct Places {
  const double *constants, *motors;
  double *state, *moved;

  QUADCORE_LAW Places(const Block& block, std::size_t first)
      : constants(block.constants + first),
        motors(block.motors + first),
        state(block.state + first),
        moved(block.work + first) {}

  QUADCORE_LAW Bodies<T> bodies(const Block& block, double* of) const {
    double* const work = block.work + TurnedRow::end(block.rotors) * widest_lanes;
    auto* const of_bodies = reinterpret_cast<BodyWork<T>*>(work);
    auto* const of_rows = reinterpret_cast<SoftRows<T>*>(of_bodies + block.rotors + 1);
    return {*block.tree, constants + ConstantRow::count(block.rotors) * widest_lanes, of, of_bodies,
            block.tree->cfm > 0 ? of_rows : nullptr};
  }
};

/// Rates of the joints of all rotors [rad/s].
template <class T>
struct JointRates {
  T of[most_rotors];

  QUADCORE_LAW void read(const Bodies<T>& bodies) {
    for (std::size_t i = 1; i < bodies.size(); ++i) of[i - 1] = bodies.joint_rate(i);
  }
};

/// Motion of the i-th rotors, see laws/rotor_forces.hpp.
template <class T>
struct MovingRotor : HingedRotor<T, Lanes::vehicles> {
  const JointRates<T>& rates;

  QUADCORE_LAW MovingRotor(const Bodies<T>& bodies, const HingedFrame<T>& frame,
                           const JointRates<T>& of_rotors, std::size_t i)
      : HingedRotor<T, Lanes::vehicles>{bodies, frame, i}, rates(of_rotors) {}

  QUADCORE_LAW T rate() const { return rates.of[this->i]; }
  QUADCORE_LAW Vec3<T> in_frame(const Vec3<T>& f_R) const {
    const Vec3<T> x = this->x_F(), y = this->y_F(), z = this->normal_F();
    return Matrix3<T>{x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z} * f_R;
  }
  QUADCORE_LAW bool windy() const { return false; }
  QUADCORE_LAW Vec3<T> v_WA_F() const { return {T{}, T{}, T{}}; }
  QUADCORE_LAW Vec3<T> w_WF_F() const { return this->frame.w_WF_F; }
  QUADCORE_LAW Vec3<T> v_WF_W() const { return this->frame.R_WF * this->frame.v_WF_F; }
};

template <class T>
QUADCORE_LAW void push(const Block& block, const Places<T>& at, Bodies<T>& bodies,
                       const HingedFrame<T>& frame, const JointRates<T>& rates) {
  const Table<T> constants{at.constants}, motors{at.motors};
  bodies.clear_forces();
  const Vec3<T> none{T{}, T{}, T{}};
  Vec3<T> f_F = none, tau_F = none, reaction_F = none;
  if (block.laws.drag) {
    const HingedCenter<T> center(bodies, frame);
    const Vec3<T>& v_F = center.v_WCcm_F;
    f_F = laws::parasitic_drag(v_F, laws::square_root(laws::dot(v_F, v_F)),
                               constants.number(ConstantRow::frame_drag));
    tau_F = laws::cross(center.p_FCcm_F, f_F);
  }
  if (block.laws.airframe) {
    const HingedCenter<T> center(bodies, frame);
    const auto k = coefficients_of_airframe(constants);
    const Vec3<T> air_F = laws::airframe_force(k, center.v_WCcm_F);
    f_F = f_F + air_F;
    tau_F = tau_F + laws::cross(center.p_FCcm_F, air_F) +
            laws::airframe_torque(k, center.v_WCcm_F, frame.w_WF_F);
  }
  for (std::size_t i = 0; i < block.rotors; ++i) {
    const MovingRotor<T> rotor(bodies, frame, rates, i);
    laws::RotorLoads<T> loads{none, none, T{}};
    laws::add_rotor_forces(laws_of_rotors(block.laws, constants, i), rotor, loads);
    const T rate = rotor.rate();
    loads.joint_torque =
        loads.joint_torque +
        laws::motor_torque<T>(motors.number(i * MotorRow::count + MotorRow::active),
                              constants.number(ConstantRow::kp),
                              motors.number(i * MotorRow::count + MotorRow::target), T{}, rate);
    reaction_F = reaction_F + loads.reaction_F;
    push_rotor(bodies, frame, i, loads.f_F, loads.joint_torque, rate);
  }
  push_frame(bodies, frame, f_F, tau_F + reaction_F);
}

/// Return the distance of the fall that OdeEngine expects while it looks ahead for contacts, and
/// that of a speed for the vehicle's shapes. Vehicles leave before OdeEngine checks for contacts,
/// so that it has already taken a step.
template <class T>
QUADCORE_LAW T distance_ahead(const Block& block, const HingedFrame<T>& frame, T speed, double dt) {
  const double* const g = block.gravity_W;
  const double time = (steps_beside_contact + 10) * dt,
               fallen =
                   (10 + laws::square_root(g[0] * g[0] + g[1] * g[1] + g[2] * g[2])) * time * time;
  const T rate = laws::square_root(laws::dot(frame.w_WF_F, frame.w_WF_F));
  return fallen + time * (speed + (5 * block.bounds.reach) * rate);
}

/// Return the vehicles for which no plugin needs to check the state at the start of a step, and
/// which will not come near the ground soon.
template <class T>
QUADCORE_LAW Mask<T> is_quiet(const Block& block, const Bodies<T>& bodies,
                              const HingedFrame<T>& frame, const JointRates<T>& rates,
                              std::size_t first, double dt) {
  const Bounds& bounds = block.bounds;
  Mask<T> good = ~Mask<T>{};
  const Mask<T> spins = laws::load_bits<T>(block.may_spin + first);
  for (std::size_t i = 0; i < block.rotors; ++i) {
    good &= mask<T>(laws::absolute(rates.of[i]) < bounds.fastest) | spins;
  }
  if (bounds.has_ground) {
    const T z = bodies.state(0).number(BodyRow::position + 2);
    const T v_z = bodies.state(0).number(BodyRow::velocity + 2);
    good &= mask<T>(z >= bounds.reach + distance_ahead(block, frame, laws::absolute(v_z), dt));
  }
  if (!bounds.no_tilt) return good;
  // Plugins transform the normal to the frame and back, which rounds it.
  constexpr double surely_up = 1e-12;
  for (std::size_t i = 0; i < block.rotors; ++i) {
    good &= mask<T>(bodies.work(i + 1).R_WB.zz >= surely_up) |
            laws::load_bits<T>(block.may_tilt + first);
  }
  return good;
}

template <class T>
QUADCORE_LAW Outcome<T> outcome(const Bodies<T>& bodies, const JointRates<T>& rates) {
  const auto square = [&](std::size_t row) QUADCORE_INLINED {
    const Vec3<T> a = bodies.state(0).vector(row);
    return laws::dot(a, a);
  };
  T sum{};
  for (std::size_t i = 1; i < bodies.size(); ++i) sum = sum + rates.of[i - 1] * rates.of[i - 1];
  return {square(BodyRow::position), square(BodyRow::velocity), square(BodyRow::rate), sum};
}

template <class T>
QUADCORE_LAW void fly(const Block& block, std::size_t first, std::int64_t count, double dt) {
  const Places<T> at(block, first);
  const std::size_t numbers = HingedRow::state(block.rotors) * widest_lanes;
  copy_flying<T>(at.state, at.moved, numbers, ~Mask<T>{});
  Bodies<T> bodies = at.bodies(block, at.moved);
  bodies.read();
  JointRates<T> rates;
  rates.read(bodies);
  Mask<T> flies = laws::load_bits<T>(block.flies + first);
  Mask<T> steps = laws::load_bits<T>(block.steps + first);
  for (std::int64_t n = 0; n < count; ++n) {
    const HingedFrame<T> frame(bodies);
    flies &= is_quiet(block, bodies, frame, rates, first, dt);
    if (block.clear) {
      const Vec3<T> v_W = bodies.state(0).vector(BodyRow::velocity);
      const T ahead = distance_ahead(block, frame, laws::square_root(laws::dot(v_W, v_W)), dt);
      flies &=
          stays_clear(block, first, bodies.state(0).vector(BodyRow::position), ahead, steps, count);
    }
    if (!laws::any(flies)) break;
    push(block, at, bodies, frame, rates);
    bodies.turn_inertias(true);
    flies &= mask<T>(bodies.read_hinges(dt) <= bodies.max_correction_squared());
    bodies.advance(dt);
    bodies.read();
    rates.read(bodies);
    flies &= is_sound(block.bounds, outcome(bodies, rates));
    steps -= flies;
    copy_flying<T>(at.moved, at.state, numbers, flies);
    add_rates<T>(block, first, flies, [&](std::size_t i) QUADCORE_INLINED { return rates.of[i]; });
  }
  laws::store_bits<T>(block.steps + first, steps);
}

}  // namespace

template <int W>
void step_hinged_block(const Block& block, std::int64_t count, double dt) {
  for (std::size_t first = 0; first < widest_lanes; first += W) {
    fly<laws::Pack<W>>(block, first, count, dt);
  }
}

template <int W>
void show_hinged_block(const Block& block, double* shown) {
  using T = laws::Pack<W>;
  for (std::size_t first = 0; first < widest_lanes; first += W) {
    const Places<T> at(block, first);
    Bodies<T> bodies = at.bodies(block, at.state);
    bodies.read();
    const HingedFrame<T> frame(bodies);
    JointRates<T> rates;
    rates.read(bodies);
    const auto put = [&](std::size_t row, T a)
                         QUADCORE_INLINED { laws::store(shown + first + row * widest_lanes, a); };
    const auto put3 = [&](std::size_t row, const Vec3<T>& a)
                          QUADCORE_INLINED { put(row, a.x), put(row + 1, a.y), put(row + 2, a.z); };
    put3(StateRow::position, frame.p_WF);
    for (std::size_t k = 0; k < 4; ++k) {
      put(StateRow::orientation + k, bodies.state(0).number(BodyRow::orientation + k));
    }
    put3(StateRow::velocity, frame.R_WF * frame.v_WF_F);
    put3(StateRow::rate, frame.w_WF_F);
    for (std::size_t i = 0; i < block.rotors; ++i) {
      const MovingRotor<T> rotor(bodies, frame, rates, i);
      put(StateRow::joint(StateRow::joint_rate, i), rotor.rate());
      put3(TurnedRow::rotor(TurnedRow::axis_F, i, block.rotors), rotor.axis_F());
      put3(TurnedRow::rotor(TurnedRow::R_FR, i, block.rotors), rotor.x_F());
      put3(TurnedRow::rotor(TurnedRow::R_FR + 3, i, block.rotors), rotor.y_F());
      put3(TurnedRow::rotor(TurnedRow::R_FR + 6, i, block.rotors), rotor.normal_F());
    }
  }
}

template void step_hinged_block<QUADCORE_LANES>(const Block&, std::int64_t, double);
template void show_hinged_block<QUADCORE_LANES>(const Block&, double*);

}  // namespace quadcore::batch
