#include "rotor_forces.hpp"

namespace quadcore::aerodynamic {

template <int W>
void add_rotor_forces(const RotorForces& law) {
  using T = laws::Pack<W>;
  for (std::size_t i = 0; i < law.rotors.rotors; i += W) {
    const RotorDisc<T> disc = law.disc<T>(i);
    Vec3<T> f_F = laws::thrust(disc, law.coefficient<T>(CoefficientRow::k, i)) +
                  laws::rotor_drag(disc, law.coefficient<T>(CoefficientRow::linear, i));
    if (law.parasitic) f_F = f_F + law.parasitic_F<T>(i);
    if (law.flaps) f_F = f_F + law.flapping_F<T>(disc, i);
    double* loads = law.rotors.loads + rotor_offset(LoadRow::count, i);
    double* force = loads + LoadRow::force * widest_lanes;
    double* reaction = loads + LoadRow::reaction * widest_lanes;
    laws::store3(force, laws::load3<T>(force) + f_F);
    const T torque = law.reaction(disc, i);
    if (law.about_frame_z) {
      double* z = reaction + 2 * widest_lanes;
      laws::store(z, laws::load<T>(z) + torque);
    } else {
      laws::store3(reaction, laws::load3<T>(reaction) + torque * disc.axis_F);
    }
  }
}

template void add_rotor_forces<QUADCORE_LANES>(const RotorForces&);

}  // namespace quadcore::aerodynamic
