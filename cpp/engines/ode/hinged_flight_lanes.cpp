#include "hinged_flight.hpp"
#include "hinged_motion.hpp"
#include "lanes/four.hpp"
#include "laws/rotors.hpp"

namespace quadcore {
namespace {

template <int W>
using Bodies = HingedBodies<laws::Pack<W>, Lanes::rotors>;

template <int W>
QUADCORE_LAW Bodies<W> bodies_of(const HingedFlight& flight) {
  using T = laws::Pack<W>;
  return {flight.tree, flight.constants, flight.state, reinterpret_cast<BodyWork<T>*>(flight.work),
          reinterpret_cast<SoftRows<T>*>(flight.soft)};
}

template <int W>
QUADCORE_LAW std::size_t packs_of_rotors(const HingedFlight& flight) {
  return (flight.rotors + W - 1) / W;
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

}  // namespace

template <int W, bool has_32_registers>
void read_hinged(const HingedFlight& flight) {
  bodies_of<W>(flight).read();
}

template <int W, bool has_32_registers>
void clear_hinged(const HingedFlight& flight) {
  bodies_of<W>(flight).clear_forces();
}

template <int W, bool has_32_registers>
void push_hinged(const HingedFlight& flight, const FlightLoads& loads) {
  using T = laws::Pack<W>;
  const Bodies<W> bodies = bodies_of<W>(flight);
  const HingedFrame<T> frame(bodies);
  push_frame(bodies, frame, laws::broadcast<T>(loads.frame_force_F),
             laws::broadcast<T>(loads.frame_torque_F));
  for (std::size_t i = 0; i < packs_of_rotors<W>(flight); ++i) {
    const std::size_t joint = joint_of<W>(flight, i);
    const double* rows = loads.rotors + rotor_offset(LoadRow::count, i * W);
    push_rotor(bodies, frame, joint, laws::load3<T>(rows + LoadRow::force * widest_lanes),
               laws::load<T>(rows + LoadRow::joint_torque * widest_lanes),
               bodies.joint_rate(joint + 1));
  }
}

template <int W, bool has_32_registers>
bool advance_hinged(const HingedFlight& flight, double dt, bool gyroscopic) {
  Bodies<W> bodies = bodies_of<W>(flight);
  bodies.turn_inertias(gyroscopic);
  if (laws::any(bodies.read_hinges(dt) > bodies.max_correction_squared())) return false;
  bodies.advance(dt);
  bodies.read();
  return true;
}

template <int W, bool has_32_registers>
void show_hinged(const HingedFlight& flight, const ShownFlight& shown) {
  using T = laws::Pack<W>;
  const Bodies<W> bodies = bodies_of<W>(flight);
  const HingedFrame<T> frame(bodies);
  const Matrix3<T>& R = frame.R_WF;
  for (std::size_t k = 0; k < 4; ++k) {
    shown.frame[FrameNumber::q_WF + k] = flight.state[(BodyRow::orientation + k) * widest_lanes];
  }
  store_one(shown.frame + FrameNumber::R_WF, Vec3<T>{R.xx, R.yx, R.zx});
  store_one(shown.frame + FrameNumber::R_WF + 3, Vec3<T>{R.xy, R.yy, R.zy});
  store_one(shown.frame + FrameNumber::R_WF + 6, Vec3<T>{R.xz, R.yz, R.zz});
  store_one(shown.frame + FrameNumber::w_WF_F, frame.w_WF_F);
  store_one(shown.frame + FrameNumber::v_WF_F, frame.v_WF_F);
  store_one(shown.frame + FrameNumber::p_WF, frame.p_WF);
  for (std::size_t i = 0; i < packs_of_rotors<W>(flight); ++i) {
    const HingedRotor<T, Lanes::rotors> rotor{bodies, frame, joint_of<W>(flight, i)};
    double* const to = shown.motion + rotor_offset(MotionRow::count, i * W);
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

template <int W, bool has_32_registers>
void find_hinge_loads(const HingedFlight& flight) {
  const Bodies<W> bodies = bodies_of<W>(flight);
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    bodies.work(i).load_of_hinge = bodies.load_of_hinge(i);
  }
}

template void read_hinged<QUADCORE_LANES, QUADCORE_HAS_32_REGISTERS>(const HingedFlight&);
template void clear_hinged<QUADCORE_LANES, QUADCORE_HAS_32_REGISTERS>(const HingedFlight&);
template void push_hinged<QUADCORE_LANES, QUADCORE_HAS_32_REGISTERS>(const HingedFlight&,
                                                                     const FlightLoads&);
template bool advance_hinged<QUADCORE_LANES, QUADCORE_HAS_32_REGISTERS>(const HingedFlight&, double,
                                                                        bool);
template void show_hinged<QUADCORE_LANES, QUADCORE_HAS_32_REGISTERS>(const HingedFlight&,
                                                                     const ShownFlight&);
template void find_hinge_loads<QUADCORE_LANES, QUADCORE_HAS_32_REGISTERS>(const HingedFlight&);

}  // namespace quadcore
