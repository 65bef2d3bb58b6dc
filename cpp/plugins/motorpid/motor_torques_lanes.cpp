#include "laws/motor_torque.hpp"
#include "motor_torques.hpp"

namespace quadcore::motorpid {

template <int W>
void add_motor_torques(const MotorTorques& law, const RotorLanes& rotors) {
  using T = laws::RotorPack<W>;
  laws::for_each_pack<laws::rotors_in_pack<W>>(rotors.rotors, [&](std::size_t i) QUADCORE_INLINED {
    const double* rate =
        rotors.motion + rotor_offset(MotionRow::count, i) + MotionRow::rate * widest_lanes;
    double* torque =
        rotors.loads + rotor_offset(LoadRow::count, i) + LoadRow::joint_torque * widest_lanes;
    laws::store(torque, laws::load<T>(torque) + laws::motor_torque<T>(law, i, laws::load<T>(rate)));
  });
}

template void add_motor_torques<QUADCORE_LANES>(const MotorTorques&, const RotorLanes&);

}  // namespace quadcore::motorpid
