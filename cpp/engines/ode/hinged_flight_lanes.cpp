#include "hinged_flight.hpp"
#include "hinged_motion.hpp"
#include "lanes/four.hpp"
#include "laws/airframe.hpp"
#include "laws/motor_torque.hpp"
#include "laws/shown_motion.hpp"

namespace quadcore {
namespace {

template <int W>
using Bodies = HingedBodies<laws::RotorPack<W>, Lanes::rotors>;

template <int W>
QUADCORE_LAW Bodies<W> bodies_of(const HingedFlight& flight) {
  using T = laws::RotorPack<W>;
  return {flight.tree, flight.constants, flight.state, reinterpret_cast<BodyWork<T>*>(flight.work),
          reinterpret_cast<SoftRows<T>*>(flight.soft)};
}

template <int W>
QUADCORE_LAW std::size_t packs_of_rotors(const HingedFlight& flight) {
  constexpr std::size_t pack = laws::rotors_in_pack<W>;
  return (flight.rotors + pack - 1) / pack;
}

/// Work on the i-th pack of rotors. Packs require that all joints belong to rotors.
template <int W>
QUADCORE_LAW std::size_t joint_of(const HingedFlight& flight, std::size_t i) {
  return W > 1 ? i : flight.joints[i];
}

/// Work on the frame, which is the same in all lanes.
template <class T>
QUADCORE_LAW void store_one(double* to, const Vec3<T>& a) {
  if constexpr (laws::lanes_of<T> == 1) {
    laws::store_vector(to, laws::Four{a.x, a.y, a.z, 0});
  } else {
    laws::store_vector(to, laws::Four{a.x[0], a.y[0], a.z[0], 0});
  }
}

/// Wrench of the air on the frame, about its origin.
struct WrenchOfAir {
  Vec3<double> force_F{0, 0, 0}, torque_F{0, 0, 0};
};

QUADCORE_LAW WrenchOfAir wrench_of_air(const LawViews& views, const double* shown_frame) {
  const auto shown = [&](std::size_t number)
                         QUADCORE_INLINED { return laws::vec(shown_frame + number); };
  const Vec3<double> V_F = shown(FrameNumber::v_WCcm_F), p_FCcm_F = shown(FrameNumber::p_FCcm_F);
  WrenchOfAir sum;
  const auto add = [&](const Vec3<double>& f_F) QUADCORE_INLINED {
    sum.force_F = sum.force_F + f_F;
    sum.torque_F = sum.torque_F + laws::cross(p_FCcm_F, f_F);
  };
  views.frame_drags.for_each([&](const FrameDrag& law) QUADCORE_INLINED {
    add(laws::parasitic_drag(V_F, __builtin_sqrt(laws::dot(V_F, V_F)), law.coefficient));
  });
  views.airframes.for_each([&](const AirframeLaws& law) QUADCORE_INLINED {
    const auto k = [&](std::size_t row) QUADCORE_INLINED { return law.coefficients[row]; };
    add(laws::airframe_force(k, V_F));
    sum.torque_F = sum.torque_F + laws::airframe_torque(k, V_F, shown(FrameNumber::w_WF_F));
  });
  return sum;
}

}  // namespace

template <int W>
void read_hinged(const HingedFlight& flight) {
  bodies_of<W>(flight).read();
}

template <int W>
void clear_hinged(const HingedFlight& flight) {
  bodies_of<W>(flight).clear_forces();
}

template <int W>
void push_hinged(const HingedFlight& flight, const FlightLoads& loads) {
  using T = laws::RotorPack<W>;
  const Bodies<W> bodies = bodies_of<W>(flight);
  const HingedFrame<T> frame(bodies);
  push_frame(bodies, frame, laws::broadcast<T>(loads.frame_force_F),
             laws::broadcast<T>(loads.frame_torque_F));
  for (std::size_t i = 0; i < packs_of_rotors<W>(flight); ++i) {
    const std::size_t joint = joint_of<W>(flight, i);
    const double* rows = loads.rotors + rotor_offset(LoadRow::count, i * laws::rotors_in_pack<W>);
    push_rotor(bodies, frame, joint, laws::load3<T>(rows + LoadRow::force * widest_lanes),
               laws::load<T>(rows + LoadRow::joint_torque * widest_lanes),
               bodies.joint_rate(joint + 1));
  }
}

template <int W>
bool push_hinged_laws(const HingedFlight& flight, const LawViews& views, const ShownFlight& shown) {
  using T = laws::RotorPack<W>;
  Bodies<W> bodies = bodies_of<W>(flight);
  bodies.clear_forces();
  const HingedFrame<T> frame(bodies);
  const WrenchOfAir air = wrench_of_air(views, shown.frame);
  const laws::ShownMotion motion{{shown.motion, nullptr, flight.rotors, true}, shown.frame};
  laws::Four reaction_F{}, rest{};  // of all rotors; `rest` shows only whether it is finite
  for (std::size_t i = 0; i < packs_of_rotors<W>(flight); ++i) {
    const std::size_t joint = joint_of<W>(flight, i);
    const T rate = bodies.joint_rate(joint + 1);
    const Vec3<T> none{T{}, T{}, T{}};
    laws::RotorLoads<T> loads{none, none, T{}};
    views.rotor_forces.for_each([&](const RotorForces& law) QUADCORE_INLINED {
      laws::add_rotor_forces<T>(law, motion, i * laws::rotors_in_pack<W>, loads);
    });
    views.motor_torques.for_each([&](const MotorTorques& law) QUADCORE_INLINED {
      loads.joint_torque =
          loads.joint_torque + laws::motor_torque<T>(law, i * laws::rotors_in_pack<W>, rate);
    });
    laws::add_in_order(reaction_F, loads.reaction_F);
    const Vec3<T>& f_F = loads.f_F;
    laws::add_in_order(rest, Vec3<T>{f_F.x + f_F.y + f_F.z, loads.joint_torque, T{}});
    push_rotor(bodies, frame, joint, f_F, loads.joint_torque, rate);
  }
  const Vec3<double> tau_F =
      air.torque_F + Vec3<double>{reaction_F[0], reaction_F[1], reaction_F[2]};
  push_frame(bodies, frame, laws::broadcast<T>(air.force_F), laws::broadcast<T>(tau_F));
  return laws::is_finite(air.force_F.x + air.force_F.y + air.force_F.z + tau_F.x + tau_F.y +
                         tau_F.z + rest[0] + rest[1]);
}

template <int W>
bool advance_hinged(const HingedFlight& flight, double dt, bool gyroscopic) {
  Bodies<W> bodies = bodies_of<W>(flight);
  bodies.turn_inertias(gyroscopic);
  if (laws::any(bodies.read_hinges(dt) > bodies.max_correction_squared())) return false;
  bodies.advance(dt);
  bodies.read();
  return true;
}

template <int W>
void show_hinged(const HingedFlight& flight, const ShownFlight& shown) {
  using T = laws::RotorPack<W>;
  const Bodies<W> bodies = bodies_of<W>(flight);
  const HingedFrame<T> frame(bodies);
  const Matrix3<T>& R = frame.R_WF;
  const double* const q = flight.state + BodyRow::orientation * widest_lanes;
  laws::store(shown.frame + FrameNumber::q_WF,
              laws::Four{q[0], q[widest_lanes], q[2 * widest_lanes], q[3 * widest_lanes]});
  store_one(shown.frame + FrameNumber::R_WF, Vec3<T>{R.xx, R.yx, R.zx});
  store_one(shown.frame + FrameNumber::R_WF + 3, Vec3<T>{R.xy, R.yy, R.zy});
  store_one(shown.frame + FrameNumber::R_WF + 6, Vec3<T>{R.xz, R.yz, R.zz});
  store_one(shown.frame + FrameNumber::w_WF_F, frame.w_WF_F);
  store_one(shown.frame + FrameNumber::v_WF_F, frame.v_WF_F);
  store_one(shown.frame + FrameNumber::p_WF, frame.p_WF);
  for (std::size_t i = 0; i < packs_of_rotors<W>(flight); ++i) {
    const HingedRotor<T, Lanes::rotors> rotor{bodies, frame, joint_of<W>(flight, i)};
    double* const to = shown.motion + rotor_offset(MotionRow::count, i * laws::rotors_in_pack<W>);
    const auto put = [to](std::size_t row, const Vec3<T>& v)
                         QUADCORE_INLINED { laws::store3(to + row * widest_lanes, v); };
    const Vec3<T> z_F = rotor.normal_F();
    put(MotionRow::axis, rotor.axis_F());
    put(MotionRow::normal, z_F);
    put(MotionRow::p_FRcm, rotor.p_FRcm_F());
    put(MotionRow::v_WR, rotor.velocity_F(true));
    put(MotionRow::v_WRcm, rotor.velocity_F(false));
    laws::store(to + MotionRow::rate * widest_lanes, rotor.rate());
    put(MotionRow::R_FR, rotor.x_F());
    put(MotionRow::R_FR + 3, rotor.y_F());
    put(MotionRow::R_FR + 6, z_F);
  }
  const HingedCenter<T> center(bodies, frame);
  store_one(shown.frame + FrameNumber::p_FCcm_F, center.p_FCcm_F);
  store_one(shown.frame + FrameNumber::v_WCcm_F, center.v_WCcm_F);
}

template <int W>
void find_hinge_loads(const HingedFlight& flight) {
  const Bodies<W> bodies = bodies_of<W>(flight);
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    bodies.work(i).load_of_hinge = bodies.load_of_hinge(i);
  }
}

template void read_hinged<QUADCORE_LANES>(const HingedFlight&);
template void clear_hinged<QUADCORE_LANES>(const HingedFlight&);
template void push_hinged<QUADCORE_LANES>(const HingedFlight&, const FlightLoads&);
template bool push_hinged_laws<QUADCORE_LANES>(const HingedFlight&, const LawViews&,
                                               const ShownFlight&);
template bool advance_hinged<QUADCORE_LANES>(const HingedFlight&, double, bool);
template void show_hinged<QUADCORE_LANES>(const HingedFlight&, const ShownFlight&);
template void find_hinge_loads<QUADCORE_LANES>(const HingedFlight&);

}  // namespace quadcore
