#include "laws/rotors.hpp"
#include "motor_torques.hpp"

namespace quadcore::motorpid {

template <int W>
void add_motor_torques(const MotorTorques& law) {
  using T = laws::Pack<W>;
  laws::for_each_pack<W>(law.rotors.rotors, [&](std::size_t i) QUADCORE_INLINED {
    const double* motion = law.rotors.motion + rotor_offset(MotionRow::count, i);
    const double* rows = law.memory + rotor_offset(MemoryRow::count, i);
    const auto memory = [rows](std::size_t row) {
      return laws::load<T>(rows + row * widest_lanes);
    };
    double* torque =
        law.rotors.loads + rotor_offset(LoadRow::count, i) + LoadRow::joint_torque * widest_lanes;
    const T error =
        laws::load<T>(motion + MotionRow::rate * widest_lanes) - memory(MemoryRow::target);
    laws::store(torque,
                laws::load<T>(torque) + memory(MemoryRow::active) *
                                            (-law.kp * error + memory(MemoryRow::sampled_torque)));
  });
}

template void add_motor_torques<QUADCORE_LANES>(const MotorTorques&);

}  // namespace quadcore::motorpid
