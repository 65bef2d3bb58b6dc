#include "command_motors.hpp"
#include "lanes/mask.hpp"
#include "lanes/table.hpp"
#include "laws/motor_target.hpp"
#include "laws/variation.hpp"

namespace quadcore::batch {
namespace {

template <class T>
QUADCORE_LAW void command(const Block& block, const int* places, const Commands& commands,
                          std::size_t first) {
  const double* const speeds = commands.speeds + first * commands.width;
  const auto speed = [&](std::size_t i)
                         QUADCORE_INLINED { return laws::load<T>(speeds + i * laws::lanes_of<T>); };
  laws::Mask<T> are_finite = ~laws::Mask<T>{};
  for (std::size_t i = 0; i < commands.width; ++i) {
    are_finite &= laws::mask<T>(laws::is_finite(speed(i)));
    double* const variation =
        commands.variation + i * laws::VariationRow::count * widest_lanes + first;
    if (commands.are_first) laws::begin_variation(variation, speed(i));
    laws::add_variation(variation, speed(i));
  }
  laws::store_bits<T>(commands.are_finite + first, are_finite);

  const laws::Mask<T> takes = laws::load_bits<T>(commands.takes + first);
  const laws::Table<T, widest_lanes> constants{block.constants + first};
  const T fastest = constants.number(ConstantRow::fastest),
          sim_slow = constants.number(ConstantRow::motors_sim_slow);
  for (std::size_t i = 0; i < block.rotors; ++i) {
    if (places[i] < 0) continue;
    const T wanted = speed(static_cast<std::size_t>(places[i]));
    const auto set = [&](std::size_t row, T number) QUADCORE_INLINED {
      double* const to = block.motors + (i * MotorRow::count + row) * widest_lanes + first;
      laws::store(to, laws::chosen_by(takes, number, laws::load<T>(to)));
    };
    set(MotorRow::active, laws::broadcast<T>(1));
    set(MotorRow::target, laws::motor_target(wanted, fastest, sim_slow));
  }
}

}  // namespace

template <int W>
void command_motors(const Block& block, const int* places, const Commands& commands) {
  for (std::size_t first = 0; first < widest_lanes; first += W) {
    command<laws::Pack<W>>(block, places, commands, first);
  }
}

template void command_motors<QUADCORE_LANES>(const Block&, const int*, const Commands&);

}  // namespace quadcore::batch
