#include "rotor_forces.hpp"

namespace quadcore::aerodynamic {

template <int W>
void add_rotor_forces(const RotorForcesNow& now) {
  using T = laws::Pack<W>;
  laws::for_each_pack<W>(now.rotors.rotors, [&](std::size_t i) QUADCORE_INLINED {
    const RotorDisc<T> disc = now.disc<T>(i);
    Vec3<T> f_F = laws::thrust(disc, now.coefficient<T>(CoefficientRow::k, i)) +
                  laws::rotor_drag(disc, now.coefficient<T>(CoefficientRow::linear, i));
    if (now.law.parasitic) f_F = f_F + now.parasitic_F<T>(i);
    if (now.law.flaps) f_F = f_F + now.flapping_F<T>(disc, i);
    double* loads = now.rotors.loads + rotor_offset(LoadRow::count, i);
    double* force = loads + LoadRow::force * widest_lanes;
    double* reaction = loads + LoadRow::reaction * widest_lanes;
    laws::store3(force, laws::load3<T>(force) + f_F);
    const T torque = now.reaction(disc, i);
    if (now.law.about_frame_z) {
      double* z = reaction + 2 * widest_lanes;
      laws::store(z, laws::load<T>(z) + torque);
    } else {
      laws::store3(reaction, laws::load3<T>(reaction) + torque * disc.axis_F);
    }
  });
}

template void add_rotor_forces<QUADCORE_LANES>(const RotorForcesNow&);

}  // namespace quadcore::aerodynamic
