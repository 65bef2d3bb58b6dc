#include "rotor_forces.hpp"

namespace quadcore::aerodynamic {

template <int W>
void add_rotor_forces(const RotorForcesNow& now) {
  using T = laws::Pack<W>;
  laws::for_each_pack<W>(now.rotors.rotors, [&](std::size_t i) QUADCORE_INLINED {
    double* loads = now.rotors.loads + rotor_offset(LoadRow::count, i);
    double* force = loads + LoadRow::force * widest_lanes;
    double* reaction = loads + LoadRow::reaction * widest_lanes;
    const auto add = [](double* row, const Vec3<T>& a)
                         QUADCORE_INLINED { laws::store3(row, laws::load3<T>(row) + a); };
    const RotorDisc<T> disc = now.disc<T>(i);
    add(force, laws::thrust(disc, now.coefficient<T>(CoefficientRow::k, i)) +
                   laws::rotor_drag(disc, now.coefficient<T>(CoefficientRow::linear, i)));
    const T torque = now.reaction(disc, i);
    if (now.law.about_frame_z) {
      double* z = reaction + 2 * widest_lanes;
      laws::store(z, laws::load<T>(z) + torque);
    } else {
      add(reaction, torque * now.reaction_axis_F(disc, i));
    }
    if (now.law.on_rotor) {
      double* joint = loads + LoadRow::joint_torque * widest_lanes;
      laws::store(joint, laws::load<T>(joint) + torque);
    }
    if (now.law.flaps) add(force, now.flapping_F<T>(disc, i));
    if (now.law.parasitic) add(force, now.parasitic_F<T>(i));
  });
}

template void add_rotor_forces<QUADCORE_LANES>(const RotorForcesNow&);

}  // namespace quadcore::aerodynamic
