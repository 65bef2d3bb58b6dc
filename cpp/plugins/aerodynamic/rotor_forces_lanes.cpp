#include "add_rotor_forces.hpp"

namespace quadcore::aerodynamic {

template <int W>
void add_rotor_forces(const RotorForces& law, const laws::ShownMotion& shown) {
  using T = laws::RotorPack<W>;
  laws::for_each_pack<laws::rotors_in_pack<W>>(
      shown.rotors.rotors, [&](std::size_t i) QUADCORE_INLINED {
        double* rows = shown.rotors.loads + rotor_offset(LoadRow::count, i);
        double* force = rows + LoadRow::force * widest_lanes;
        double* reaction = rows + LoadRow::reaction * widest_lanes;
        double* joint_torque = rows + LoadRow::joint_torque * widest_lanes;
        laws::RotorLoads<T> loads{laws::load3<T>(force), laws::load3<T>(reaction),
                                  laws::load<T>(joint_torque)};
        laws::add_rotor_forces<T>(law, shown, i, loads);
        laws::store3(force, loads.f_F);
        laws::store3(reaction, loads.reaction_F);
        laws::store(joint_torque, loads.joint_torque);
      });
}

template void add_rotor_forces<QUADCORE_LANES>(const RotorForces&, const laws::ShownMotion&);

}  // namespace quadcore::aerodynamic
